//! What starts by itself: the schedules, their next runs, quiet hours, and a form for one of them.

mod clock_field;
mod form;
mod quiet;
mod zone;

use leptos::prelude::*;
use panel_logic::{
    HomeRows, ScheduleForm, ScheduleRow, Template, next_rows, past_rows, refusal_text, schedule_rows,
    zone_text,
};
use rvac_api::{Failure, RequestBody, ScheduleView, Schedules};

use crate::access::{EDITS_SCHEDULES, Needs, OnlyLooks};
use crate::language::words;
use crate::row_menu::RowMenu;
use crate::store::{SCHEDULE_ID, Store};
use crate::toasts::Undo;
use form::FormView;
use quiet::QuietView;
use zone::ZoneView;

/// The reason of the robot for a change of something that somebody else has changed.
const CHANGED_MEANWHILE: &str = "changed-meanwhile";

/// Handles on all of it; cheap to copy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScheduleDesk {
    known: RwSignal<Option<Schedules>>,
    /// What is filled in, if anything is.
    form: RwSignal<Option<ScheduleForm>>,
    /// What is wrong with it.
    wrong: RwSignal<Option<String>>,
    /// Somebody else has changed the schedule meanwhile: a person chooses which one stays.
    conflicts: RwSignal<bool>,
}

impl ScheduleDesk {
    pub(crate) fn new() -> Self {
        Self {
            known: RwSignal::new(None),
            form: RwSignal::new(None),
            wrong: RwSignal::new(None),
            conflicts: RwSignal::new(false),
        }
    }

    pub(crate) fn on_schedules(self, schedules: Schedules) {
        self.known.set(Some(schedules));
    }

    /// What was filled in is kept.
    pub(crate) fn on_done(self, id: u32) {
        if id == SCHEDULE_ID {
            self.form.set(None);
            self.wrong.set(None);
            self.conflicts.set(false);
        }
    }

    /// Whether the refusal concerns the form, beside which it is displayed.
    pub(crate) fn on_failed(self, failure: &Failure) -> bool {
        let is_ours = failure.id == Some(SCHEDULE_ID);
        if is_ours {
            self.conflicts.set(failure.reason == CHANGED_MEANWHILE);
            self.wrong
                .set(Some(refusal_text(words(), &failure.reason, &failure.text)));
        }
        is_ours
    }

    fn open(self, form: ScheduleForm) {
        self.wrong.set(None);
        self.conflicts.set(false);
        self.form.set(Some(form));
    }

    fn with<T: Default>(self, read: impl FnOnce(&Schedules) -> T) -> T {
        self.known
            .with(|known| known.as_ref().map(read).unwrap_or_default())
    }

    /// The schedules for people; a view that asks follows them.
    fn rows_of(self, store: Store) -> Vec<ScheduleRow> {
        let places = store.orders.places.get();
        let rows_of = |rooms: &Vec<_>, floors: &_| {
            let home = HomeRows {
                rooms,
                places: &places,
                floors,
            };
            self.with(|known| schedule_rows(words(), known, home))
        };
        store
            .rooms
            .with(|rooms| store.floors.with(|floors| rows_of(rooms, floors)))
    }

    fn view_of(self, number: u32) -> Option<ScheduleView> {
        let find = |known: &Schedules| known.entries.iter().find(|view| view.number == number).cloned();
        self.known.with_untracked(|known| known.as_ref().and_then(find))
    }
}

#[component]
pub(crate) fn ScheduleSheet(store: Store) -> impl IntoView {
    let desk = store.schedules;
    let rows = Memo::new(move |_| desk.rows_of(store));
    view! {
        <div class="home" id="schedule-sheet">
            <OnlyLooks store verb=EDITS_SCHEDULES />
            <p class="hint" id="schedule-zone">{move || desk.known.with(|known| known.as_ref().map(|known| zone_text(words(), known)))}</p>
            <h3 id="schedules-title">{words().schedule.schedules}</h3>
            <ul id="schedules" class="rows schedules" aria-labelledby="schedules-title">
                <For each=move || rows.get() key=|row| row.number let:row>
                    <Entry store number=row.number rows />
                </For>
            </ul>
            <Show when=move || rows.with(Vec::is_empty)>
                <p class="hint">{words().schedule.none}</p>
            </Show>
            <Show
                when=move || desk.form.with(Option::is_some)
                fallback=move || view! {
                    <div class="draw-tools">
                        <Needs store verb=EDITS_SCHEDULES>
                            <button type="button" class="small strong" id="add-schedule" on:click=move |_| store.open_schedule(ScheduleForm::default())>
                                {words().schedule.add}
                            </button>
                        </Needs>
                    </div>
                }
            >
                <FormView store />
            </Show>
            <Needs store verb=EDITS_SCHEDULES>
                <QuietView store />
                <ZoneView store />
            </Needs>
            {list("next-runs", words().schedule.next_runs, words().schedule.no_next, move || desk.with(|known| next_rows(words(), known)))}
            {list("past-runs", words().schedule.past_runs, words().schedule.no_past, move || desk.with(|known| past_rows(words(), known)))}
        </div>
    }
}

/// A list of sentences under a title, or what is said when there are none.
fn list(
    id: &'static str,
    title: &'static str,
    none: &'static str,
    rows: impl Fn() -> Vec<String> + Copy + Send + Sync + 'static,
) -> impl IntoView {
    view! {
        <h3 id=format!("{id}-title")>{title}</h3>
        <ul id=id class="sentences" aria-labelledby=format!("{id}-title")>
            {move || rows().into_iter().map(|text| view! { <li>{text}</li> }).collect_view()}
        </ul>
        <Show when=move || rows().is_empty()>
            <p class="hint">{none}</p>
        </Show>
    }
}

/// A schedule; its buttons stay the same while its words change, so that a keyboard does not lose them.
#[component]
fn Entry(store: Store, number: u32, rows: Memo<Vec<ScheduleRow>>) -> impl IntoView {
    let row = Memo::new(move |_| rows.with(|rows| rows.iter().find(|row| row.number == number).cloned()));
    let text = move |part: fn(&ScheduleRow) -> &String| {
        move || row.with(|row| row.as_ref().map(|row| part(row).clone()))
    };
    let enabled = move || row.with(|row| row.as_ref().is_some_and(|row| row.enabled));
    view! {
        <li id=format!("schedule-{number}")>
            <Needs store verb=EDITS_SCHEDULES>
                <label class="check">
                    <input
                        type="checkbox"
                        id=format!("enable-{number}")
                        prop:checked=enabled
                        on:change=move |event| store.ask(RequestBody::EnableSchedule { number, enabled: event_target_checked(&event) })
                    />
                    <strong>{text(|row| &row.name)}</strong>
                </label>
            </Needs>
            <p class="words">{text(|row| &row.words)}</p>
            <p class="words next">{text(|row| &row.next)}</p>
            <p class="words">{text(|row| &row.now)}</p>
            <EntryTools store number row />
        </li>
    }
}

/// What can be done with a schedule.
#[component]
fn EntryTools(store: Store, number: u32, row: Memo<Option<ScheduleRow>>) -> impl IntoView {
    let skips = move || row.with(|row| row.as_ref().is_some_and(|row| row.skips));
    let name = move || row.with(|row| row.as_ref().map(|row| row.name.clone()).unwrap_or_default());
    let labelled = move |what: Template<1>| move || what.fill([&name()]);
    let skip = move |_| {
        let skip = !untrack(skips);
        store.ask(RequestBody::SkipNext { number, skip });
    };
    let edit = move |_| {
        if let Some(view) = store.schedules.view_of(number) {
            store.open_schedule(ScheduleForm::of(&view));
        }
    };
    view! {
        <div class="draw-tools">
            <Needs store verb="skip-next">
                <button
                    type="button"
                    class="small choose"
                    id=format!("skip-{number}")
                    aria-label=labelled(words().schedule.skip_named)
                    aria-pressed=move || if skips() { "true" } else { "false" }
                    on:click=skip
                >
                    {words().schedule.skip}
                </button>
                <button
                    type="button"
                    class="small"
                    id=format!("run-{number}")
                    aria-label=labelled(words().schedule.run_named)
                    on:click=move |_| store.ask(RequestBody::RunSchedule { number })
                >
                    {words().schedule.run}
                </button>
            </Needs>
            <Needs store verb=EDITS_SCHEDULES>
                <RowMenu of=format!("schedule-{number}") name=untrack(name)>
                <button type="button" class="small" id=format!("edit-{number}") aria-label=labelled(words().schedule.edit_named) on:click=edit>
                    {words().schedule.edit}
                </button>
                <button
                    type="button"
                    class="small"
                    id=format!("remove-{number}")
                    aria-label=labelled(words().schedule.remove_named)
                    on:click=move |_| store.remove_schedule(number)
                >
                    {words().frame.remove}
                </button>
                </RowMenu>
            </Needs>
        </div>
    }
}

impl Store {
    /// Opens the form, on a device that may save it.
    fn open_schedule(self, form: ScheduleForm) {
        if self.admits(EDITS_SCHEDULES) {
            self.schedules.open(form);
        }
    }

    /// The schedule as somebody else has left it.
    fn their_schedule(self) -> Option<ScheduleView> {
        let number = self
            .schedules
            .form
            .with_untracked(|form| form.as_ref().and_then(|form| form.number));
        self.schedules.view_of(number?)
    }

    /// The same for people.
    fn their_words(self) -> String {
        let Some(theirs) = self.their_schedule() else {
            return String::new();
        };
        let rows = self.schedules.rows_of(self);
        let row = rows.into_iter().find(|row| row.number == theirs.number);
        row.map_or(theirs.entry.name, |row| format!("{}: {}", row.name, row.words))
    }

    /// Lays what is filled in aside for what somebody else has made of it.
    fn take_theirs(self) {
        if let Some(theirs) = self.their_schedule() {
            self.open_schedule(ScheduleForm::of(&theirs));
        }
    }

    /// Saves what is filled in, whatever somebody else has made of it.
    fn keep_mine(self) {
        if let Some(theirs) = self.their_schedule() {
            self.schedules.conflicts.set(false);
            self.schedules.form.update(|form| {
                if let Some(form) = form {
                    form.keep_mine(&theirs);
                }
            });
            self.save_schedule();
        }
    }

    /// Removes a schedule; for a while it can be taken back.
    fn remove_schedule(self, number: u32) {
        let removed = self.schedules.view_of(number);
        self.ask(RequestBody::RemoveSchedule { number });
        self.undo.set(removed.map(|view| Undo {
            what: words().schedule.was_removed.fill([&view.entry.name]),
            body: RequestBody::AddSchedule(view.entry),
        }));
    }

    /// Asks for what is filled in, or says what is missing.
    fn save_schedule(self) {
        let request = self
            .schedules
            .form
            .with_untracked(|form| form.as_ref().map(|form| form.request(words())));
        match request {
            Some(Ok(body)) => self.ask_as(SCHEDULE_ID, body),
            Some(Err(missing)) => self.schedules.wrong.set(Some(missing.to_owned())),
            None => {}
        }
    }
}
