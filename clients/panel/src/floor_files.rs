//! Floors as one file: saved from the robot, and handed to it.

use leptos::prelude::*;
use panel_logic::{FloorUpload, floor_file_problem, refusal_text};
use rvac_api::{Failure, FloorView};
use wasm_bindgen_futures::JsFuture;
use web_sys::File;

use crate::access::Needs;
use crate::file_button::FileButton;
use crate::language::words;
use crate::store::Store;

/// Number of the requests that hand a file over.
const ARCHIVE_ID: u32 = 7;
/// Where the server gives all floors as a file, and how that is called.
const ADDRESS: &str = "/api/floors/archive";
const FILE_NAME: &str = "home.rvacfloors";

/// An upload to the robot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FloorDesk {
    upload: RwSignal<Option<FloorUpload>>,
    /// How it went.
    remark: RwSignal<Option<String>>,
}

impl FloorDesk {
    pub(crate) fn new() -> Self {
        Self {
            upload: RwSignal::new(None),
            remark: RwSignal::new(None),
        }
    }

    fn end(self, remark: String) {
        self.upload.set(None);
        self.remark.set(Some(remark));
    }

    /// The robot refuses something; whether it was this.
    pub(crate) fn on_failed(self, failure: &Failure) -> bool {
        let is_ours = failure.id == Some(ARCHIVE_ID);
        if is_ours {
            self.end(refusal_text(words(), &failure.reason, &failure.text));
        }
        is_ours
    }

    /// The connection is lost, and with it the upload.
    pub(crate) fn on_close(self) {
        if self.upload.with_untracked(Option::is_some) {
            self.end(words().home.floors_lost.to_owned());
        }
    }

    async fn read(self, store: Store, file: File) {
        if let Some(problem) = floor_file_problem(words(), file.size() as u64) {
            self.end(problem);
            return;
        }
        match JsFuture::from(file.array_buffer()).await {
            Ok(buffer) => {
                let bytes = js_sys::Uint8Array::new(&buffer).to_vec();
                self.remark.set(None);
                self.upload.set(Some(FloorUpload::new(bytes)));
                store.hand_floors();
            }
            Err(_) => self.end(words().home.floors_unreadable.to_owned()),
        }
    }
}

impl Store {
    /// A numbered request was done; if it was a piece the next one goes.
    pub(crate) fn on_floors_done(self, id: u32) {
        if id == ARCHIVE_ID && self.floor_desk.upload.with_untracked(Option::is_some) {
            self.hand_floors();
        }
    }

    fn hand_floors(self) {
        let next = self
            .floor_desk
            .upload
            .try_update(|upload| upload.as_mut().and_then(FloorUpload::next_piece));
        match next.flatten() {
            Some(piece) => self.ask_as(ARCHIVE_ID, piece),
            None => self.floor_desk.end(words().home.floors_taken.to_owned()),
        }
    }
}

#[component]
pub(crate) fn FloorFiles(store: Store) -> impl IntoView {
    let desk = store.floor_desk;
    let has_map = Memo::new(move |_| {
        let is_mapped = |floor: &FloorView| !floor.removed && floor.area_m2 > 0.0;
        store.floors.with(|view| view.floors.iter().any(is_mapped))
    });
    let told = move || {
        let share = desk.upload.with(|upload| upload.as_ref().map(FloorUpload::share));
        match share {
            Some(share) => Some(words().home.floors_sent.fill([&words().number(100.0 * share, 0)])),
            None => desk.remark.get(),
        }
    };
    view! {
        <div class="draw-tools">
            <Show when=move || has_map.get()>
                <a class="small link" id="export-floors" href=ADDRESS download=FILE_NAME>{words().home.export_floors}</a>
            </Show>
            <Needs store verb="import-floors">
            <FileButton
                id="import-floors"
                file_id="floors-file"
                text=words().home.import_floors
                label=words().home.floors_file
                accept=".rvacfloors"
                disabled=Signal::derive(move || desk.upload.with(Option::is_some))
                on_file=move |file| leptos::task::spawn_local(desk.read(store, file))
            />
            </Needs>
        </div>
        <p class="hint" id="floors-remark" role="status">{told}</p>
    }
}
