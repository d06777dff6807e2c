//! The robot's map of the home, in words and in three parts: the rooms; zones, restricted areas and the dock; floors and stored maps.

use std::time::Duration;

use leptos::prelude::*;
use panel_logic::{Edit, area_text, estimate_sentences};
use rvac_api::{KeptMap, RequestBody};

use crate::access::{EDITS_HOME, Needs, OnlyLooks};
use crate::dock_view::DockPlace;
use crate::floors_view::FloorList;
use crate::history::date_text;
use crate::language::words;
use crate::places_view::PlaceList;
use crate::rooms_view::{NoGoList, RoomList};
use crate::store::Store;

/// A board whose clock shows less has a clock that was not set.
const CLOCK_IS_SET_FROM_S: i64 = 1_704_067_200;
/// The list of stored maps is requested so often while it is shown.
const RENEW_EVERY: Duration = Duration::from_secs(5);

/// What of the home is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HomePart {
    Rooms,
    Zones,
    Maps,
}

impl HomePart {
    const ALL: [Self; 3] = [Self::Rooms, Self::Zones, Self::Maps];

    /// Of its element; its button has the same name with `show-` before it.
    const fn id(self) -> &'static str {
        match self {
            Self::Rooms => "home-rooms",
            Self::Zones => "home-zones",
            Self::Maps => "home-maps",
        }
    }

    fn title(self) -> &'static str {
        let texts = &words().home;
        match self {
            Self::Rooms => texts.rooms,
            Self::Zones => texts.zones,
            Self::Maps => texts.all_maps,
        }
    }
}

#[component]
pub(crate) fn HomeSheet(
    store: Store,
    /// The part that is shown; it outlives the sheet, which is made anew whenever its tab is opened.
    open: RwSignal<HomePart>,
) -> impl IntoView {
    store.ask_for_maps();
    // A map is stored some seconds after a run, and no message announces it.
    if let Ok(renewal) = set_interval_with_handle(move || store.ask_for_maps(), RENEW_EVERY) {
        on_cleanup(move || renewal.clear());
    }
    let choice = move |part: HomePart| {
        view! {
            <button
                type="button"
                id=format!("show-{}", part.id())
                aria-pressed=move || if open.get() == part { "true" } else { "false" }
                on:click=move |_| open.set(part)
            >
                {part.title()}
            </button>
        }
    };
    view! {
        <div class="home" id="home-sheet">
            <OnlyLooks store verb=EDITS_HOME />
            <div class="passes home-parts" role="group" aria-label=words().home.parts>
                {HomePart::ALL.map(choice).collect_view()}
            </div>
            <section class="home-part" id=HomePart::Rooms.id() hidden=move || open.get() != HomePart::Rooms>
                <Sentences store />
                <RoomList store />
            </section>
            <section class="home-part" id=HomePart::Zones.id() hidden=move || open.get() != HomePart::Zones>
                <PlaceList store />
                <NoGoList store />
                <DockPlace store />
            </section>
            <section class="home-part" id=HomePart::Maps.id() hidden=move || open.get() != HomePart::Maps>
                <FloorList store />
                <MapList store />
            </section>
        </div>
    }
}

/// How sure the robot is of its place, and what it has felt of the floor.
#[component]
fn Sentences(store: Store) -> impl IntoView {
    let sentences = move || {
        store.estimate.with(|estimate| {
            estimate
                .as_ref()
                .map(|estimate| estimate_sentences(words(), estimate))
                .unwrap_or_default()
        })
    };
    view! {
        <ul class="sentences">
            {move || sentences().into_iter().chain(store.carpet.get()).map(|text| view! { <li>{text}</li> }).collect_view()}
        </ul>
    }
}

/// The versions of the map that are kept.
#[component]
fn MapList(store: Store) -> impl IntoView {
    view! {
        <h3 id="maps-title">{words().home.maps}</h3>
        <ul id="maps" class="rows" aria-labelledby="maps-title">
            {move || {
                let maps = store.maps.get();
                maps.into_iter().enumerate().map(|(place, map)| kept(store, place, map)).collect_view()
            }}
        </ul>
        <Show when=move || store.maps.with(Vec::is_empty)>
            <p class="hint">{words().home.no_maps}</p>
        </Show>
    }
}

impl Store {
    /// Asks which versions of the map of the floor are kept.
    pub(crate) fn ask_for_maps(self) {
        let floor = self.floors.with_untracked(|view| view.here);
        self.ask_quietly(RequestBody::Maps { floor });
    }

    /// Takes a version of the map up again, so that the newest one can be brought back.
    fn take_up(self, after: u64) {
        let newest = self
            .maps
            .with_untracked(|maps| maps.first().map(|map| map.number));
        if let Some(before) = newest {
            let floor = self.maps_floor.get_untracked();
            self.edit(Edit::TakeUp { floor, before, after });
        }
    }
}

/// How many rooms.
pub(crate) fn rooms_text(count: u32) -> String {
    match count {
        1 => words().home.room_one.to_owned(),
        _ => words().home.room_many.fill([&count]),
    }
}

fn kept(store: Store, place: usize, map: KeptMap) -> impl IntoView {
    let texts = &words().home;
    let kept_s = i64::try_from(map.kept_s).ok();
    let extent = format!(
        "{}, {}, {}",
        date_text(kept_s.filter(|kept_s| *kept_s >= CLOCK_IS_SET_FROM_S)),
        area_text(words(), map.area_m2),
        rooms_text(map.rooms)
    );
    view! {
        <li>
            <span class="name">{texts.map.fill([&map.number])}</span>
            <span class="words">{extent}</span>
            {map.doubted.then(|| view! { <span class="newest">{texts.was_doubted}</span> })}
            {map.last_good.then(|| view! { <span class="newest">{texts.last_good}</span> })}
            {if place == 0 {
                view! { <span class="newest">{texts.in_use}</span> }.into_any()
            } else {
                view! {
                    <Needs store verb=EDITS_HOME>
                        <button
                            type="button"
                            class="small"
                            id=format!("take-up-{}", map.number)
                            aria-label=texts.restore_map.fill([&map.number])
                            on:click=move |_| store.take_up(map.number)
                        >
                            {texts.take_up}
                        </button>
                    </Needs>
                }
                .into_any()
            }}
        </li>
    }
}
