//! Recordings as files for the browser.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::rig::{Daemon, Rig};

const ASK: &str = "GET /api/runs/7/recording/0 HTTP/1.1\r\nHost: localhost:PORT\r\nConnection: close\r\n\r\n";

async fn give(vthal: &mut Daemon, from: usize, whole: &[u8]) {
    let heard = vthal.hear().await.expect("asks");
    let wanted = format!(r#"{{"id":1,"c":"run-file","number":7,"recording":0,"from":{from}}}"#);
    assert_eq!(heard, wanted);
    let end = whole.len().min(from + 5);
    let (data, size) = (STANDARD.encode(&whole[from..end]), whole.len());
    let piece = format!(
        r#"{{"e":"run-file","number":7,"name":"run-a.mcap","from":{from},"size":{size},"data":"{data}"}}"#
    );
    vthal.say(&piece).await;
    vthal.say(r#"{"e":"done","id":1}"#).await;
}

#[tokio::test]
async fn a_recording_comes_whole_with_its_name() {
    let rig = Rig::start().await;
    let serve = async {
        let mut vthal = rig.accept().await;
        for from in [0, 5, 10] {
            give(&mut vthal, from, b"twelve bytes").await;
        }
    };
    let (answer, ()) = tokio::join!(rig.raw(ASK), serve);
    let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
    assert!(head.starts_with("HTTP/1.1 200"), "{head}");
    let head = head.to_ascii_lowercase();
    for line in [
        "content-disposition: attachment; filename=\"run-a.mcap\"",
        "content-length: 12",
        "x-content-type-options: nosniff",
    ] {
        assert!(head.contains(line), "{line} in {head}");
    }
    assert_eq!(body, "twelve bytes");
}

#[tokio::test]
async fn what_is_made_while_it_is_read_ends_with_an_empty_piece() {
    for texts in [&["twelve", " bytes", ""][..], &["twelve"]] {
        let rig = Rig::start().await;
        let serve = async {
            let mut vthal = rig.accept().await;
            let mut from = 0;
            for text in texts {
                let heard = vthal.hear().await.expect("asks");
                let wanted = format!(r#"{{"id":1,"c":"run-file","number":7,"from":{from}}}"#);
                assert_eq!(heard, wanted);
                let data = STANDARD.encode(text);
                let piece =
                    format!(r#"{{"e":"run-file","number":7,"name":"a.mcap","from":{from},"data":"{data}"}}"#);
                vthal.say(&piece).await;
                from += text.len();
            }
        };
        let ask = ASK.replace("recording/0", "recording");
        let (answer, ()) = tokio::join!(rig.raw(&ask), serve);
        let is_ended = answer.ends_with("6\r\ntwelve\r\n6\r\n bytes\r\n0\r\n\r\n");
        assert_eq!(is_ended, texts.len() == 3, "{answer}");
        assert!(is_ended == answer.ends_with("0\r\n\r\n"), "{answer}");
    }
}

#[tokio::test]
async fn a_recording_that_is_not_there_is_shown_in_words() {
    let rig = Rig::start().await;
    let serve = async {
        let mut vthal = rig.accept().await;
        vthal.hear().await.expect("asks");
        vthal
            .say(r#"{"e":"failed","id":1,"reason":"no-such-run","text":"No run 7 is kept."}"#)
            .await;
    };
    let (answer, ()) = tokio::join!(rig.raw(ASK), serve);
    assert!(
        answer.starts_with("HTTP/1.1 404") && answer.ends_with("No run 7 is kept.\n"),
        "{answer}"
    );
}

#[tokio::test]
async fn a_page_of_another_site_gets_no_recording() {
    let rig = Rig::start().await;
    let foreign = ASK.replace("Connection", "Sec-Fetch-Site: cross-site\r\nConnection");
    assert!(rig.raw(&foreign).await.starts_with("HTTP/1.1 403"));
}

#[tokio::test]
async fn an_address_without_the_number_of_a_run_names_what_is_wrong() {
    let rig = Rig::start().await;
    for number in ["/seven/", "/18446744073709551616/", "/-1/"] {
        let answer = rig.raw(&ASK.replace("/7/", number)).await;
        assert!(answer.starts_with("HTTP/1.1 404"), "{answer}");
        assert!(answer.contains("has the number of a run in it"), "{answer}");
    }
}

#[tokio::test]
async fn floors_come_as_one_file_and_not_if_a_map_changes_on_the_way() {
    for (last_check, is_whole) in [(7, true), (8, false)] {
        let rig = Rig::start().await;
        let serve = async {
            let mut vthal = rig.accept().await;
            for (from, check, text) in [(0, 7, "twelve"), (6, last_check, " bytes")] {
                let heard = vthal.hear().await.expect("asks");
                assert_eq!(heard, format!(r#"{{"id":1,"c":"export-floors","from":{from}}}"#));
                let data = STANDARD.encode(text);
                let piece = format!(
                    r#"{{"e":"floor-archive","from":{from},"size":12,"check":{check},"data":"{data}"}}"#
                );
                vthal.say(&piece).await;
            }
        };
        let ask = ASK.replace("runs/7/recording/0", "floors/archive");
        let (answer, ()) = tokio::join!(rig.raw(&ask), serve);
        assert!(answer.contains("filename=\"home.rvacfloors\""), "{answer}");
        assert_eq!(answer.ends_with("twelve bytes"), is_whole, "{answer}");
    }
}
