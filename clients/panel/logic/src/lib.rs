//! State and decisions of the panel, without browser and framework, so that tests run on the host.
//!
//! Words used here. The *camera* says which part of the map is seen. The *playout* turns poses that arrive now and then into
//! motion that flows. The *driver* turns what hands do into drive requests under a lease, by a control mix. An *offer* says
//! whether a button can be used and why not. The *words* are every text of the page in every language, and *codes* are what the
//! robot says, to be put into words.
#![forbid(unsafe_code)]

mod calibration;
mod camera;
mod carpet;
mod clock_field;
mod codes;
mod connection;
mod currency;
mod decimal;
mod device_rows;
mod dock_place;
mod driver;
mod edit_log;
mod edits;
mod evidence;
mod figures;
mod floor_upload;
mod frame_meter;
mod grip;
mod health;
mod history;
mod home;
mod job_progress;
mod job_settings;
mod kept_places;
mod latency;
mod learnt;
mod lending;
mod log_book;
mod map_palette;
mod matter;
mod mixes;
mod name_layout;
mod names;
mod notices;
mod offers;
mod orbit;
mod plan;
mod playout;
mod point;
mod pressing;
mod primary;
mod qr;
mod reshape;
mod room_changes;
mod room_choice;
mod room_settings;
mod schedule_form;
mod schedule_rows;
mod sketch;
mod software;
mod statistics;
mod swept_chance;
mod swept_grid;
mod system_rows;
mod thoughts;
mod tilt;
mod wall_blocks;
mod words;

pub use calibration::{
    calibration_name, danger_text, is_held, lacking_text, live_text, measured_text, task_text, value_state,
};
pub use camera::{Bounds, Camera, ScreenBox, View};
pub use carpet::carpet_sentence;
pub use clock_field::time_of_day;
pub use codes::{
    Explanation, decision_text, explain, failure_text, log_text, question_text, refusal_text, run_text,
    state_title, strategy_title,
};
pub use connection::Backoff;
pub use currency::{Currency, News, PieceJoiner};
pub use decimal::read_decimal;
pub use device_rows::{Row, Section, device_sections};
pub use dock_place::{DockPose, dock_border, dock_contacts, dock_pose, dock_text, known_dock};
pub use driver::{Driver, away_text, keys_of, knob_place, silent_text, top_speeds};
pub use edit_log::{Change, EditLog, Step};
pub use edits::{Edit, EditError, Forbidden, Kept};
pub use evidence::{EvidenceRow, evidence_rows};
pub use figures::{area_text, clock_text, distance_text, percent_text, scale_bar};
pub use floor_upload::{FloorUpload, floor_file_problem};
pub use frame_meter::FrameMeter;
pub use grip::{Grip, PadEvent, Pointer, PointerKind};
pub use health::{HoursRow, PartRow, part_rows};
pub use history::{
    Plot, Replay, RunDrawing, RunRow, StopRow, plots, room_here_text, run_drawing, run_figures, run_rows,
    stop_rows,
};
pub use home::{ITEMS_MAX, ROOM_TINTS, RoomRow, has_carpet, home_plan, room_name, room_rows, wall_strokes};
pub use job_progress::{JobProgress, headline, route_length_m, run_summary};
pub use job_settings::{JobSettings, SettingChoice};
pub use kept_places::{PlaceRow, place_rows};
pub use latency::LatencyMeter;
pub use learnt::{LearntRobot, LearntRow, learnt_robots};
pub use lending::{LENT_NAME_MAX, Lending, lending_text, lent_name};
pub use log_book::{LogBook, LogFilter};
pub use map_palette::{MapPalette, Rgb};
pub use matter::{MatterSight, matter_sight};
pub use mixes::{
    CalibrationRun, CurvePoints, Field, FieldError, FieldKind, Group, InputPart, Learning, LineCurve,
    LinePart, MixDraft, MixProblem, ModePart, OutputPart, SwitchPart, TrimPart, output_title,
    profile_problem_text, robot_has,
};
pub use name_layout::{NameBox, lay_out_names};
pub use names::name_problem_text;
pub use notices::{Notice, NoticeWatch, run_notice};
pub use offers::{Offer, Offers, PauseKind, Wait};
pub use orbit::{Orbit, Projection};
pub use plan::{PlanPalette, outlined, plan_bounds, plan_pixels};
pub use playout::Playout;
pub use point::{MapPoint, Pixel};
pub use pressing::Presses;
pub use primary::{Primary, Wishes};
pub use qr::QrPicture;
pub use reshape::{HANDLE_FINE_STEP_M, HANDLE_STEP_M, Handle, Outline, Reshape, Reshaped, Target};
pub use room_changes::{RoomChangeRow, joinable, room_change_rows};
pub use room_choice::{DrawnPart, PASSES_MAX, RoomChoice, job_estimate_text, room_at, whole_home_text};
pub use room_settings::{PowerPart, pattern_text, room_settings_text};
pub use schedule_form::ScheduleForm;
pub use schedule_rows::{
    HomeRows, ScheduleRow, day_text, floor_elsewhere, floor_title, next_rows, past_rows, schedule_rows,
    zone_text,
};
pub use sketch::{Drawn, NoGoRow, Sketch, Tool, no_go_rows, no_go_strokes, spot_border, zone_strokes};
pub use software::{
    StepState, UpdateRow, UpdateSight, step_text, update_file_problem, update_obstacle, update_sight,
};
pub use statistics::{statistics_headline, statistics_rows};
pub use swept_grid::{DirtyRows, SweptGrid};
pub use system_rows::system_rows;
pub use thoughts::{DecisionBook, estimate_sentences, path_dashes, place_text};
pub use tilt::Tilt;
pub use wall_blocks::{BLOCK_NUMBERS, WallBlocks};
pub use words::{Language, Template, Words};
