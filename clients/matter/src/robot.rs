//! What the clusters know of the robot and ask of it: one value for all of them.

use std::cell::{Ref, RefCell, RefMut};
use std::time::Duration;

use bridge::Limiter;
use rvac_api::{JobOrder, JobPart, RequestBody};
use tokio::sync::{mpsc, oneshot, watch};
use tokio::time::{Instant, timeout};

use crate::choices::Choices;
use crate::refusal::Refusal;
use crate::view::View;

/// The daemon answers within this time, or counts as away.
const PATIENCE: Duration = Duration::from_secs(3);
/// So soon after the daemon's word the robot's state shows it.
const SHOWN_WITHIN: Duration = Duration::from_secs(1);
/// Commands that wait for the daemon at the same time; the stack answers four exchanges at once.
const ORDERS_MAX: usize = 8;

/// Something asked of the daemon.
#[derive(Debug)]
pub(crate) struct Order {
    pub(crate) body: RequestBody,
    pub(crate) answer: oneshot::Sender<Result<(), Refusal>>,
}

/// The clusters' side.
#[derive(Debug)]
pub(crate) struct Robot {
    seen: watch::Receiver<View>,
    orders: mpsc::Sender<Order>,
    choices: RefCell<Choices>,
    limiter: RefCell<Limiter>,
    begun_at: Instant,
}

/// The relay's side.
#[derive(Debug)]
pub(crate) struct Ends {
    pub(crate) shown: watch::Sender<View>,
    pub(crate) orders: mpsc::Receiver<Order>,
}

impl Robot {
    pub(crate) fn new(first: View, choices: Choices) -> (Self, Ends) {
        let (shown, seen) = watch::channel(first);
        let (orders, to_relay) = mpsc::channel(ORDERS_MAX);
        let robot = Self {
            seen,
            orders,
            choices: RefCell::new(choices),
            limiter: RefCell::default(),
            begun_at: Instant::now(),
        };
        let ends = Ends {
            shown,
            orders: to_relay,
        };
        (robot, ends)
    }

    pub(crate) fn view(&self) -> watch::Ref<'_, View> {
        self.seen.borrow()
    }

    pub(crate) fn choices(&self) -> Ref<'_, Choices> {
        self.choices.borrow()
    }

    pub(crate) fn choices_mut(&self) -> RefMut<'_, Choices> {
        self.choices.borrow_mut()
    }

    /// Whether one more command is what people could have sent.
    pub(crate) fn allows(&self) -> bool {
        self.limiter.borrow_mut().allows(self.begun_at.elapsed())
    }

    /// Asks the daemon, and waits for its word and until the state shows what was asked for.
    pub(crate) async fn ask(
        &self,
        body: RequestBody,
        is_shown: impl Fn(&View) -> bool,
    ) -> Result<(), Refusal> {
        let (answer, answered) = oneshot::channel();
        let order = Order { body, answer };
        self.orders
            .try_send(order)
            .map_err(|_| Refusal::without_daemon())?;
        timeout(PATIENCE, answered)
            .await
            .ok()
            .and_then(Result::ok)
            .unwrap_or_else(|| Err(Refusal::without_daemon()))?;
        // A state that shows it later is told when it does.
        let mut seen = self.seen.clone();
        timeout(SHOWN_WITHIN, seen.wait_for(|view| is_shown(view)))
            .await
            .ok();
        Ok(())
    }

    /// Asks without waiting for the answer: the robot beeps, or it cannot.
    pub(crate) fn beep(&self) {
        let (answer, _) = oneshot::channel();
        let body = RequestBody::Locate;
        if self.orders.try_send(Order { body, answer }).is_err() {
            tracing::info!("too much is asked at once: it does not beep");
        }
    }

    /// The job that a start begins: the rooms that were selected, in their order, as hard as was chosen.
    pub(crate) fn job(&self) -> RequestBody {
        let choices = self.choices();
        let parts: Vec<JobPart> = choices.areas().iter().copied().map(JobPart::Room).collect();
        let power = choices.speed().power();
        if parts.is_empty() && power.is_none() {
            return RequestBody::Start { strategy: None };
        }
        RequestBody::Clean(JobOrder {
            parts,
            power,
            ..JobOrder::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use bridge::FanSpeed;
    use rvac_api::{CleaningPower, JobOrder, JobPart, RequestBody};

    use super::Robot;
    use crate::choices::Choices;
    use crate::refusal::Refusal;
    use crate::store::tests::scratch;
    use crate::view::View;

    #[tokio::test]
    async fn a_start_cleans_what_was_selected_and_a_daemon_that_gives_no_answer_is_a_refusal() {
        let folder = scratch("robot");
        let (robot, mut ends) = Robot::new(View::default(), Choices::kept(&folder));
        assert_eq!(robot.job(), RequestBody::Start { strategy: None });
        robot.choices_mut().choose_areas(vec![3, 1]);
        robot.choices_mut().choose_speed(FanSpeed::Quiet);
        let wanted = RequestBody::Clean(JobOrder {
            parts: vec![JobPart::Room(3), JobPart::Room(1)],
            power: Some(CleaningPower::QUIET),
            ..JobOrder::default()
        });
        assert_eq!(robot.job(), wanted);
        let gives_up = async {
            let order = ends.orders.recv().await.expect("an order");
            assert_eq!(order.body, RequestBody::Pause);
        };
        let (silent, ()) = tokio::join!(robot.ask(RequestBody::Pause, |_| true), gives_up);
        assert_eq!(silent, Err(Refusal::without_daemon()));
        let obeys = async {
            let order = ends.orders.recv().await.expect("an order");
            order.answer.send(Ok(())).unwrap();
            ends.shown.send_modify(|view| view.state = 2);
        };
        let (asked, ()) = tokio::join!(robot.ask(RequestBody::Pause, |view| view.state == 2), obeys);
        assert_eq!((asked, robot.view().state), (Ok(()), 2));
        std::fs::remove_dir_all(folder.path("")).unwrap();
    }
}
