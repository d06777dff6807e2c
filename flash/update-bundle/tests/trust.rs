//! What is not signed, not whole or not plain is refused, each with its own reason.

use std::io::Read;

use minisign::KeyPair;
use update_bundle::{
    BundleError, ListedFile, MANIFEST_FORMAT, Manifest, ManifestFault, PublicKeys, hash_of, list_folder,
    pack, unpack, verify,
};

/// A folder that goes with the test.
struct Folder(std::path::PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("update-bundle-{name}-{}", std::process::id()));
        std::fs::create_dir_all(path.join("bin")).expect("a folder");
        std::fs::create_dir_all(path.join("panel")).expect("a folder");
        for (name, text) in [
            ("bin/vthal", "the daemon"),
            ("panel/index.html", "<p>"),
            ("panel/empty", ""),
        ] {
            std::fs::write(path.join(name), text.repeat(300)).expect("a file");
        }
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

fn key_pair() -> KeyPair {
    KeyPair::generate_unencrypted_keypair().expect("random numbers")
}

fn accepted(pairs: &[&KeyPair]) -> PublicKeys {
    let texts: Vec<String> = pairs.iter().map(|pair| pair.pk.to_base64()).collect();
    PublicKeys::parse(&texts).expect("keys")
}

fn manifest(files: Vec<ListedFile>) -> Manifest {
    Manifest {
        format: MANIFEST_FORMAT,
        epoch: 3,
        version: "0.1.0".to_owned(),
        robot: "sr8730".to_owned(),
        machine: "arm".to_owned(),
        firmware: None,
        files,
    }
}

fn signed(bytes: &[u8], pair: &KeyPair) -> String {
    let signature = minisign::sign(None, &pair.sk, bytes, None, None).expect("a signature");
    signature.into_string()
}

/// The archive with this manifest, signed.
fn archive(folder: &Folder, manifest: &Manifest, pair: &KeyPair) -> Vec<u8> {
    let bytes = serde_json::to_vec_pretty(manifest).expect("JSON");
    let mut out = Vec::new();
    pack(
        &mut out,
        (&bytes, &signed(&bytes, pair)),
        (&folder.0, &manifest.files),
    )
    .expect("packed");
    out
}

fn whole(folder: &Folder, pair: &KeyPair) -> Vec<u8> {
    archive(folder, &manifest(list_folder(&folder.0).expect("files")), pair)
}

fn refusal(archive: &[u8], keys: &PublicKeys) -> BundleError {
    verify(archive, keys, &mut |_, _| Ok(())).expect_err("it is refused")
}

#[test]
fn what_was_packed_comes_out() {
    let (folder, pair, next) = (Folder::new("whole"), key_pair(), key_pair());
    let archive = whole(&folder, &pair);
    assert_eq!(
        archive,
        whole_again(&archive, &folder),
        "the same files make the same bytes"
    );
    let bundle = verify(&archive[..], &accepted(&[&next, &pair]), &mut |_, _| Ok(())).expect("trusted");
    let mut came = Vec::new();
    unpack(&archive[..], &bundle, &mut |listed, content| {
        let mut text = String::new();
        content.read_to_string(&mut text)?;
        came.push((listed.path.clone(), text));
        Ok(())
    })
    .expect("unpacked");
    let paths: Vec<&str> = came.iter().map(|(path, _)| path.as_str()).collect();
    assert_eq!(paths, ["bin/vthal", "panel/empty", "panel/index.html"]);
    assert_eq!(came[0].1, "the daemon".repeat(300));
    assert_eq!(hash_of(came[1].1.as_bytes()), bundle.manifest.files[1].sha256);
}

/// Packs the content of an archive with its own manifest and signature.
fn whole_again(archive: &[u8], folder: &Folder) -> Vec<u8> {
    let mut entries = tar::Archive::new(archive);
    let mut texts = entries.entries().expect("entries").take(2).map(|entry| {
        let mut text = String::new();
        entry.expect("an entry").read_to_string(&mut text).expect("text");
        text
    });
    let (manifest, signature) = (texts.next().expect("first"), texts.next().expect("second"));
    let files = Manifest::parse(manifest.as_bytes()).expect("a manifest").files;
    let mut out = Vec::new();
    pack(&mut out, (manifest.as_bytes(), &signature), (&folder.0, &files)).expect("packed");
    out
}

#[test]
fn no_byte_of_manifest_or_signature_can_be_changed() {
    let (folder, pair) = (Folder::new("flips"), key_pair());
    let (archive, keys) = (whole(&folder, &pair), accepted(&[&pair]));
    let entries: Vec<(u64, u64)> = tar::Archive::new(&archive[..])
        .entries()
        .expect("entries")
        .take(2)
        .map(|entry| {
            entry
                .map(|entry| (entry.raw_file_position(), entry.size()))
                .expect("an entry")
        })
        .collect();
    let (manifest, signature) = (entries[0], entries[1]);
    let mut flipped = 0;
    for at in manifest.0..manifest.0 + manifest.1 {
        let mut changed = archive.clone();
        changed[at as usize] ^= 1 << (at % 8);
        let refused = refusal(&changed, &keys);
        assert!(
            matches!(refused, BundleError::WrongSignature),
            "byte {at}: {refused}"
        );
        flipped += 1;
    }
    assert_eq!(flipped, manifest.1);
    for at in signature.0..signature.0 + signature.1 {
        let mut changed = archive.clone();
        changed[at as usize] ^= 1;
        // The first line is for people and is not signed; a newline after the last is no part of it.
        let Err(refused) = verify(&changed[..], &keys, &mut |_, _| Ok(())) else {
            assert!(
                at < signature.0 + 60 || at + 2 > signature.0 + signature.1,
                "byte {at}"
            );
            continue;
        };
        assert!(
            matches!(
                refused,
                BundleError::WrongSignature | BundleError::SignatureFormat | BundleError::UnknownKey
            ),
            "byte {at}: {refused}"
        );
    }
}

#[test]
fn no_byte_of_a_file_or_header_can_be_changed() {
    let (folder, pair) = (Folder::new("content"), key_pair());
    let (archive, keys) = (whole(&folder, &pair), accepted(&[&pair]));
    let bundle = verify(&archive[..], &keys, &mut |_, _| Ok(())).expect("trusted");
    for at in (0..archive.len()).step_by(41) {
        let mut changed = archive.clone();
        changed[at] ^= 0x10;
        let Ok(other) = verify(&changed[..], &keys, &mut |_, _| Ok(())) else {
            continue;
        };
        // Padding and the comment of the signature change nothing that comes out.
        assert!(other.manifest == bundle.manifest, "byte {at}");
        if other != bundle {
            continue;
        }
        let mut content = archive.clone();
        content[at] = changed[at];
        let mut same = true;
        unpack(&content[..], &bundle, &mut |listed, bytes| {
            let mut came = Vec::new();
            bytes.read_to_end(&mut came)?;
            same &= hash_of(&came) == listed.sha256;
            Ok(())
        })
        .expect("the same");
        assert!(same, "byte {at}");
    }
    let start = archive
        .windows(10)
        .position(|text| text == b"the daemon")
        .expect("it is there");
    let mut changed = archive.clone();
    changed[start] ^= 1;
    let refused = refusal(&changed, &keys);
    assert!(
        matches!(&refused, BundleError::WrongHash(path) if path == "bin/vthal"),
        "{refused}"
    );
    let later = unpack(&changed[..], &bundle, &mut |_, _| Ok(())).expect_err("it was changed since");
    assert!(matches!(later, BundleError::WrongHash(_)), "{later}");
}

#[test]
fn a_file_that_is_cut_off_or_longer_is_named() {
    let (folder, pair) = (Folder::new("cut"), key_pair());
    let (archive, keys) = (whole(&folder, &pair), accepted(&[&pair]));
    for percent in 0..100 {
        let cut = &archive[..archive.len() * percent / 100];
        let refused = refusal(cut, &keys);
        assert!(
            matches!(refused, BundleError::CutOff { .. }),
            "{percent} %: {refused}"
        );
    }
    let refused = refusal(&archive[..archive.len() - 1], &keys);
    assert!(matches!(refused, BundleError::CutOff { .. }), "{refused}");
    for more in [&b"\0"[..], b"more"] {
        let refused = refusal(&[&archive[..], more].concat(), &keys);
        assert!(matches!(refused, BundleError::Longer(_)), "{refused}");
    }
}

#[test]
fn another_key_other_files_and_other_things_are_named() {
    let (folder, pair, other) = (Folder::new("other"), key_pair(), key_pair());
    let archive_of = |manifest: &Manifest| archive(&folder, manifest, &pair);
    let keys = accepted(&[&pair]);
    let listed = list_folder(&folder.0).expect("files");
    let refused = refusal(&whole(&folder, &other), &keys);
    assert!(matches!(refused, BundleError::UnknownKey), "{refused}");
    let refused = refusal(b"", &keys);
    assert!(matches!(refused, BundleError::CutOff { .. }), "{refused}");
    let refused = refusal(&[7; 4096], &keys);
    assert!(matches!(refused, BundleError::Damaged(_)), "{refused}");
    let mut newer = manifest(listed.clone());
    newer.format = 2;
    let refused = refusal(&archive_of(&newer), &keys);
    assert!(
        matches!(refused, BundleError::Manifest(ManifestFault::Format(2))),
        "{refused}"
    );
    // A manifest that lists more than is there, in the place of one that lists less.
    let mut fewer = manifest(listed.clone());
    fewer.files.pop();
    let bytes = serde_json::to_vec(&manifest(listed)).expect("JSON");
    let mut mixed = Vec::new();
    let signature = signed(&bytes, &pair);
    pack(&mut mixed, (&bytes, &signature), (&folder.0, &fewer.files)).expect("packed");
    let refused = refusal(&mixed, &keys);
    assert!(
        matches!(&refused, BundleError::NotABundle { wanted, .. } if wanted == "panel/index.html"),
        "{refused}"
    );
}

#[test]
fn keys_are_one_or_two() {
    let texts: Vec<String> = (0..3).map(|_| key_pair().pk.to_base64()).collect();
    assert!(PublicKeys::parse(&texts[..0]).is_err());
    assert!(PublicKeys::parse(&texts[..2]).is_ok());
    assert!(PublicKeys::parse(&texts).is_err());
    assert!(PublicKeys::parse(&["nothing".to_owned()]).is_err());
    let boxed = key_pair().pk.to_box().expect("a box").to_string();
    assert!(PublicKeys::parse(&[boxed]).is_ok());
}
