//! The loop around the core: the daemon's socket, the broker's connection, the clock.

use std::time::Duration;

use bridge::dial::{Dial, Stream};
use bridge::{Daemon, News, service};
use rvac_api::Topic;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::{Instant, sleep_until, timeout};

use crate::configuration::Configuration;
use crate::core::Core;
use crate::dialect::Dialect;
use crate::session::{Session, SessionNews};
use crate::voice::{Output, Voice};
use crate::wire::Login;

/// Pauses between attempts: from the first to the last, twice as long each time. The last is short, because a home wants its robot back.
const RETRY_FIRST: Duration = Duration::from_millis(500);
const RETRY_LAST: Duration = Duration::from_secs(8);
/// Without a word for so long a broker gives the bridge up.
const KEEP_ALIVE_S: u16 = 30;
/// A broker that does not take bytes for so long is as good as gone.
const WRITE_LIMIT: Duration = Duration::from_secs(8);

/// Readings and pictures are looked at so often: nothing of them is more urgent.
const WAKE_EVERY: Duration = Duration::from_secs(1);

const TOPICS: [Topic; 7] = [
    Topic::Status,
    Topic::Device,
    Topic::Map,
    Topic::Home,
    Topic::Floors,
    Topic::Schedules,
    Topic::Runs,
];

/// Runs the bridge for ever.
pub(crate) async fn run(configuration: Configuration) -> anyhow::Result<()> {
    let broker = configuration.check()?;
    service::tell_ready();
    let own = speak(&broker, Core::new(configuration.clone()), &configuration);
    match configuration.dialect_prefix.is_empty() {
        true => own.await,
        false => {
            let dialect = speak(&broker, Dialect::new(&configuration), &configuration);
            tokio::join!(own, dialect);
        }
    }
    Ok(())
}

/// Lets one side speak for ever, over a connection of its own: a broker says one will for each.
async fn speak(broker: &Dial, voice: impl Voice, configuration: &Configuration) {
    let mut shell = Shell {
        begun: Instant::now(),
        daemon: Daemon::new(configuration.vthal.clone(), "rvac-mqtt", &TOPICS),
        voice,
        wake_at: Duration::ZERO,
        configuration,
    };
    let mut pause = RETRY_FIRST;
    loop {
        let began = Instant::now();
        if let Err(error) = shell.one_connection(broker).await {
            tracing::warn!(
                broker = shell.configuration.broker,
                "{error:#}; the next attempt follows"
            );
        }
        shell.voice.broker_went();
        pause = if began.elapsed() > RETRY_LAST {
            RETRY_FIRST
        } else {
            (pause * 2).min(RETRY_LAST)
        };
        shell.without_broker(began + pause).await;
    }
}

struct Shell<'a, V> {
    begun: Instant,
    daemon: Daemon,
    voice: V,
    wake_at: Duration,
    configuration: &'a Configuration,
}

impl<V: Voice> Shell<'_, V> {
    fn now(&self) -> Duration {
        self.begun.elapsed()
    }

    /// The daemon's words are read also while there is no broker, so that they do not pile up.
    async fn without_broker(&mut self, until: Instant) {
        loop {
            tokio::select! {
                news = self.daemon.next() => {
                    let mut out = Vec::new();
                    self.take_news(news, &mut out);
                    self.ask(out, None).await;
                }
                () = sleep_until(until) => return,
            }
        }
    }

    async fn one_connection(&mut self, broker: &Dial) -> anyhow::Result<()> {
        let mut stream = self.connected(broker).await?;
        let (mut session, hello) = Session::begin(self.login(), self.voice.heard_topics(), self.now());
        stream.write_all(&hello).await?;
        let mut received = vec![0; 8 << 10];
        loop {
            let mut bytes = Vec::new();
            let session_at = session.poll(self.now(), &mut bytes)?;
            if !bytes.is_empty() {
                timeout(WRITE_LIMIT, stream.write_all(&bytes)).await??;
                stream.flush().await?;
            }
            // Not from now on: updates come more often than that.
            let wake_at = session_at.min(self.wake_at);
            let mut out = Vec::new();
            tokio::select! {
                news = self.daemon.next() => self.take_news(news, &mut out),
                count = stream.read(&mut received) => {
                    let bytes = received.get(..count?).unwrap_or_default();
                    if bytes.is_empty() {
                        anyhow::bail!("the broker has closed the connection");
                    }
                    let hello = self.take_bytes(bytes, &mut session, &mut out)?;
                    stream.write_all(&hello).await?;
                }
                () = sleep_until(self.begun + wake_at) => {}
            }
            let now = self.now();
            if now >= self.wake_at {
                self.wake_at = now + WAKE_EVERY;
                self.voice.wake(now, &mut out);
            }
            self.ask(out, Some(&mut session)).await;
        }
    }

    async fn connected(&mut self, broker: &Dial) -> anyhow::Result<Box<dyn Stream>> {
        let connecting = broker.connect();
        tokio::pin!(connecting);
        loop {
            tokio::select! {
                stream = &mut connecting => return stream,
                news = self.daemon.next() => {
                    let mut out = Vec::new();
                    self.take_news(news, &mut out);
                    self.ask(out, None).await;
                }
            }
        }
    }

    fn login(&self) -> Login {
        let configuration = self.configuration;
        Login {
            version: configuration.version,
            client_id: format!("rvac-{}{}", configuration.id, V::NAME),
            user: configuration.user.clone(),
            password: configuration.password.clone(),
            will: self.voice.will(),
            keep_alive_s: KEEP_ALIVE_S,
        }
    }

    fn take_news(&mut self, news: News, out: &mut Vec<Output>) {
        let now = self.now();
        match news {
            News::Connected => self.voice.daemon_came(out),
            News::Lost => self.voice.daemon_went(now, out),
            News::Update(update) => self.voice.update(&update, now, out),
        }
    }

    /// Gives bytes that are to be sent first.
    fn take_bytes(
        &mut self,
        bytes: &[u8],
        session: &mut Session,
        out: &mut Vec<Output>,
    ) -> anyhow::Result<Vec<u8>> {
        let now = self.now();
        let mut news = Vec::new();
        session.receive(bytes, now, &mut news)?;
        let mut first = Vec::new();
        for one in news {
            match one {
                SessionNews::Open => {
                    tracing::info!(broker = self.configuration.broker, "connected");
                    first = session.subscriptions();
                    self.voice.broker_came(now, out);
                }
                SessionNews::Message(message) => self.voice.message(&message, now, out),
            }
        }
        Ok(first)
    }

    async fn ask(&mut self, outputs: Vec<Output>, mut session: Option<&mut Session>) {
        for output in outputs {
            match (output, &mut session) {
                (Output::Ask(body), _) => {
                    if let Err(error) = self.daemon.request(body).await {
                        tracing::warn!(%error, "a request is lost");
                    }
                }
                (Output::Hello, _) => {
                    // A daemon that is away says it when it is asked again.
                    self.daemon.hello().await.ok();
                }
                (Output::State(message), Some(session)) => session.set(message),
                (Output::Event(message), Some(session)) => session.add(message),
                (_, None) => {}
            }
        }
    }
}
