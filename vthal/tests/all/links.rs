//! The real binary and links over a network: a server of ours passes the bytes of a terminal on, as ser2net does.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::time::{Duration, Instant};

use rcgen::{CertificateParams, KeyPair};
use rustls::pki_types::PrivateKeyDer;
use rustls::{ServerConfig, ServerConnection, StreamOwned};
use rvac_api::Update;
use rvac_protocol::message::BinaryKinds;
use vthal_bench::{Client, Daemon, LivingRobot, Scratch, SyntheticRobot};

/// Generous: the machine may be busy with other tests.
const PATIENCE: Duration = Duration::from_secs(20);
/// How long each side of the server waits for bytes before it looks at the other.
const TURN: Duration = Duration::from_millis(2);

/// Nothing came within a turn.
fn is_early(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut)
}

/// Passes bytes between a network and the terminal until the network ends.
fn relay(mut network: impl Read + Write, terminal: &Path) -> io::Result<()> {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let mut terminal = File::options().read(true).write(true).open(terminal)?;
    let turn = Timespec::try_from(TURN).expect("short");
    let mut bytes = [0; 1024];
    loop {
        if poll(&mut [PollFd::new(&terminal, PollFlags::IN)], Some(&turn))? > 0 {
            let count = terminal.read(&mut bytes)?;
            network.write_all(&bytes[..count])?;
            network.flush()?;
        }
        match network.read(&mut bytes) {
            Ok(0) => return Ok(()),
            Ok(count) => terminal.write_all(&bytes[..count])?,
            Err(error) if is_early(&error) => {}
            Err(error) => return Err(error),
        }
    }
}

/// A server beside the robot, one connection after another; gives its port.
fn serve<S: Read + Write>(scratch: &Scratch, dress: impl Fn(TcpStream) -> S + Send + 'static) -> u16 {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("binds");
    let port = listener.local_addr().expect("bound").port();
    let terminal = scratch.join("tty");
    std::thread::spawn(move || {
        while let Ok((stream, _)) = listener.accept() {
            stream.set_read_timeout(Some(TURN)).expect("sets");
            // A daemon that ends, or does not believe this server, ends the connection.
            relay(dress(stream), &terminal).ok();
        }
    });
    port
}

fn start(scratch: &Scratch, link: &str) -> Daemon {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vthal"));
    command
        .args(["--seed", "1", "--link", link, "--socket"])
        .arg(scratch.join("vthal.sock"))
        .arg("--state")
        .arg(scratch.join("state"));
    Daemon::start_command(command).expect("gets ready")
}

fn living_robot(scratch: &Scratch) -> LivingRobot {
    let robot = SyntheticRobot::switch_on(&scratch.join("tty"), BinaryKinds::ALL, 1).expect("a terminal");
    LivingRobot::new(robot)
}

fn wait_for(client: &mut Client, fits: impl FnMut(&Update) -> bool) -> Option<Update> {
    client.wait_for(Instant::now() + PATIENCE, fits).expect("reads")
}

/// The daemon's log, once it has this text.
fn log_with(scratch: &Scratch, wanted: &str) -> String {
    let deadline = Instant::now() + PATIENCE;
    loop {
        let text = fs::read_to_string(scratch.join("state/log/vthal.log")).unwrap_or_default();
        if text.contains(wanted) {
            return text;
        }
        assert!(Instant::now() < deadline, "no {wanted:?} in {text}");
        std::thread::park_timeout(Duration::from_millis(10));
    }
}

fn is_idle(update: &Update) -> bool {
    matches!(update, Update::Status(status) if status.state == "idle")
}

fn watch(scratch: &Scratch) -> Client {
    Client::watching(&scratch.join("vthal.sock"), r#"["status","log"]"#).expect("connects")
}

#[test]
fn a_robot_behind_a_network_is_found_and_driven() {
    let scratch = Scratch::new().expect("creates");
    let _robot = living_robot(&scratch);
    let port = serve(&scratch, |stream| stream);
    let _daemon = start(&scratch, &format!("tcp:127.0.0.1:{port}"));
    let mut client = watch(&scratch);
    assert!(
        wait_for(&mut client, is_idle).is_some(),
        "the robot does not answer"
    );
    client.send(r#"{"c":"start","id":1}"#).expect("sends");
    let done = wait_for(&mut client, |update| matches!(update, Update::Done { id: 1 }));
    assert!(done.is_some(), "it does not start");
}

#[test]
fn a_network_that_is_not_there_is_named_once_and_waited_for() {
    let scratch = Scratch::new().expect("creates");
    // It was free a moment ago, and nobody listens there.
    let port = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))
        .and_then(|listener| listener.local_addr())
        .expect("binds")
        .port();
    let _daemon = start(&scratch, &format!("tcp:127.0.0.1:{port}"));
    let wanted = format!("cannot reach 127.0.0.1 port {port}");
    let text = log_with(&scratch, &wanted);
    assert_eq!(text.matches(&wanted).count(), 1, "{text}");
}

/// A certificate for `robot`, written to a file, and a server that shows it.
fn identity(scratch: &Scratch, file: &str) -> Arc<ServerConfig> {
    let key = KeyPair::generate().expect("a key");
    let certificate = CertificateParams::new(vec!["robot".to_owned()])
        .expect("a name")
        .self_signed(&key)
        .expect("signs");
    fs::write(scratch.join(file), certificate.pem()).expect("writes");
    let secret = PrivateKeyDer::try_from(key.serialize_der()).expect("a key");
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let config = ServerConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()
        .expect("versions")
        .with_no_client_auth()
        .with_single_cert(vec![certificate.der().clone()], secret)
        .expect("fits");
    Arc::new(config)
}

/// A client that does not believe this server ends the handshake; whoever reads then learns it.
fn shake_hands(
    mut connection: ServerConnection,
    mut stream: TcpStream,
) -> StreamOwned<ServerConnection, TcpStream> {
    while connection.is_handshaking() {
        match connection.complete_io(&mut stream) {
            Ok(_) => {}
            Err(error) if is_early(&error) => {}
            Err(_) => break,
        }
    }
    StreamOwned::new(connection, stream)
}

#[test]
fn only_the_holder_of_the_named_certificate_is_believed() {
    let scratch = Scratch::new().expect("creates");
    let _robot = living_robot(&scratch);
    let ours = identity(&scratch, "ours.pem");
    identity(&scratch, "other.pem");
    let port = serve(&scratch, move |stream| {
        let connection = ServerConnection::new(Arc::clone(&ours)).expect("a server");
        shake_hands(connection, stream)
    });
    let link = |file: &str| {
        let file = scratch.join(file);
        format!("tls:127.0.0.1:{port}?name=robot&ca={}", file.display())
    };
    let daemon = start(&scratch, &link("other.pem"));
    let text = log_with(&scratch, "invalid peer certificate");
    assert!(
        !text.contains("link open"),
        "somebody else's certificate was believed: {text}"
    );
    drop(daemon);
    let _daemon = start(&scratch, &link("ours.pem"));
    let mut client = watch(&scratch);
    assert!(
        wait_for(&mut client, is_idle).is_some(),
        "the robot does not answer"
    );
}
