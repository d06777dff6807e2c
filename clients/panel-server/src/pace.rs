//! Costly steps of many connections, one at a time: between two of them everybody else has a turn.

use std::future::{Future, poll_fn};
use std::pin::pin;
use std::sync::Arc;
use std::task::Poll;

use tokio::sync::Semaphore;
use tokio::task::yield_now;

/// Shared by all connections whose steps are costly.
#[derive(Clone, Debug)]
pub(crate) struct Pace(Arc<Semaphore>);

impl Default for Pace {
    fn default() -> Self {
        Self(Arc::new(Semaphore::new(1)))
    }
}

impl Pace {
    /// Runs `steps` so that whoever has something to do does it before the next step of anybody. Nobody waits for a peer in here: who
    /// begins and says no more holds up nobody.
    pub(crate) async fn at<F: Future>(&self, steps: F) -> F::Output {
        let mut steps = pin!(steps);
        loop {
            let turn = self.0.acquire().await;
            // Sockets are looked at, and those served for whom something has come.
            yield_now().await;
            let done = poll_fn(|context| Poll::Ready(steps.as_mut().poll(context))).await;
            drop(turn);
            match done {
                Poll::Ready(output) => return output,
                // At once: what wakes the task between the step and here would be missed.
                Poll::Pending => woken().await,
            }
        }
    }
}

/// Until the task is woken for whatever it waits for.
async fn woken() {
    let mut waits = true;
    poll_fn(|_| match std::mem::take(&mut waits) {
        true => Poll::Pending,
        false => Poll::Ready(()),
    })
    .await;
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
    use tokio::net::UnixStream;

    use super::Pace;

    const CROWD: usize = 100;

    /// Two sockets that are ready to be read: those of the crowd, whose steps are costly, and one that is served.
    #[tokio::test]
    async fn between_two_costly_steps_whoever_is_served_has_a_turn() {
        let (pace, order) = (Pace::default(), Arc::new(Mutex::new(Vec::new())));
        let mut crowd = Vec::new();
        for _ in 0..CROWD {
            let (pace, order) = (pace.clone(), Arc::clone(&order));
            crowd.push(tokio::spawn(async move {
                let step = async { order.lock().unwrap().push("step") };
                pace.at(step).await;
            }));
        }
        let (mut phone, mut served) = UnixStream::pair().unwrap();
        let answers = Arc::clone(&order);
        let answering = tokio::spawn(async move {
            let mut press = [0];
            while served.read_exact(&mut press).await.is_ok() {
                answers.lock().unwrap().push("served");
                served.write_all(&press).await.unwrap();
            }
        });
        for press in 0..10 {
            phone.write_all(&[press]).await.unwrap();
            phone.read_exact(&mut [0]).await.unwrap();
        }
        drop(phone);
        answering.await.unwrap();
        for one in crowd {
            one.await.unwrap();
        }
        let order = order.lock().unwrap();
        let steps_before_last_answer = order
            .iter()
            .take(order.iter().rposition(|what| *what == "served").unwrap())
            .filter(|what| **what == "step")
            .count();
        assert!(
            steps_before_last_answer < CROWD / 2,
            "{steps_before_last_answer} steps before ten presses were answered"
        );
    }

    /// What comes while a step waits for its turn is not missed.
    #[tokio::test]
    async fn many_who_talk_to_their_peers_all_come_to_an_end() {
        let pace = Pace::default();
        let talks = (0..CROWD).map(|_| {
            let pace = pace.clone();
            let (mut peer, mut own) = UnixStream::pair().unwrap();
            let echoes = tokio::spawn(async move {
                let mut byte = [0];
                while peer.read_exact(&mut byte).await.is_ok() {
                    peer.write_all(&byte).await.unwrap();
                }
            });
            tokio::spawn(async move {
                let talk = async {
                    for number in 0..10 {
                        own.write_all(&[number]).await.unwrap();
                        own.read_exact(&mut [0]).await.unwrap();
                    }
                };
                pace.at(talk).await;
                drop(own);
                echoes.await.unwrap();
            })
        });
        for talk in talks.collect::<Vec<_>>() {
            talk.await.unwrap();
        }
    }

    #[tokio::test]
    async fn who_waits_for_a_peer_holds_up_nobody() {
        let pace = Pace::default();
        let (mut peer, mut silent) = UnixStream::pair().unwrap();
        let mut byte = [0];
        let waits = pace.at(silent.read_exact(&mut byte));
        let comes = async {
            for number in 0..10 {
                assert_eq!(pace.at(async { number }).await, number);
            }
            peer.write_all(&[7]).await.unwrap();
        };
        let (read, ()) = tokio::join!(waits, comes);
        assert_eq!(read.unwrap(), 1);
    }
}
