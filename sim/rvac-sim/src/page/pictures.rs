//! The page's pictures as files of their own, for documents: the same curves and plans, on paper of their own colour, so that
//! they can be read on dark pages as well as on light ones.

use crate::trace::KeptRun;

use super::{coverage, home, map, number, pose_error};

/// Paper of charts, and of plans, whose floor is white.
const PAPER: &str = "#ffffff";
const GROUND: &str = "#aab0b5";

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Name of its file.
    pub name: String,
    /// An SVG document.
    pub svg: String,
}

/// Pictures of runs in one home: `coverage.svg`, `place.svg`, and for each run, in the order given, `1-way.svg` and, if it
/// has a map, `1-map.svg`.
#[must_use]
pub fn pictures(runs: &[KeptRun]) -> Vec<Picture> {
    let Some(first) = runs.first() else {
        return Vec::new();
    };
    let of_home: Vec<&KeptRun> = runs.iter().filter(|run| home(run) == home(first)).collect();
    let t0_s = number(first, "t0_s").unwrap_or(0.0).max(1.0);
    let picture = |name: &str, drawn: &str, paper: &str| Picture {
        name: name.to_owned(),
        svg: document(drawn, paper),
    };
    let mut all = vec![
        picture("coverage.svg", &coverage(&of_home, t0_s), PAPER),
        picture("place.svg", &pose_error(&of_home), PAPER),
    ];
    for (run, number) in of_home.iter().zip(1..) {
        all.push(picture(&format!("{number}-way.svg"), &map::truth(run), GROUND));
        if let Some(drawn) = map::drawn(run) {
            all.push(picture(&format!("{number}-map.svg"), &drawn, GROUND));
        }
    }
    all
}

/// Makes a document from the content of a page.
fn document(inline: &str, paper: &str) -> String {
    let (head, content) = inline.split_once('>').unwrap_or(("<svg", inline));
    let head = head.replacen("<svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"", 1);
    format!(
        "{head}><style>text{{font:12px sans-serif;fill:#55606a}}</style><rect width=\"100%\" height=\"100%\" fill=\"{paper}\"/>{content}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::document;

    #[test]
    fn a_document_has_a_name_space_and_paper_below_its_content() {
        let made = document(
            "<svg viewBox=\"0 0 2 1\" role=\"img\"><path d=\"M0 0\"/></svg>",
            "#fff",
        );
        assert_eq!(
            made,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 2 1\" role=\"img\">\
             <style>text{font:12px sans-serif;fill:#55606a}</style>\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/><path d=\"M0 0\"/></svg>\n"
        );
    }
}
