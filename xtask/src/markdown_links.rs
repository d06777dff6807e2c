//! Links in Markdown, and where they lead.

use std::path::{Component, Path, PathBuf};

/// Where a target begins and ends: links and pictures of Markdown, and pictures of HTML, which can have a width.
const FORMS: [(&str, char); 2] = [("](", ')'), ("src=\"", '"')];

/// Targets of links and pictures in Markdown.
pub(crate) fn targets(text: &str) -> impl Iterator<Item = &str> {
    let (begin, end) = FORMS[0];
    text.split(begin)
        .skip(1)
        .filter_map(move |after| after.split_once(end))
        .map(|(target, _)| target)
}

/// Gives `text` with each target of a link or picture replaced by what `renamed` makes of it; what it gives `None` for stays.
pub(crate) fn rewritten(text: &str, mut renamed: impl FnMut(&str) -> Option<String>) -> String {
    FORMS.iter().fold(text.to_owned(), |text, form| {
        rewritten_in_form(&text, *form, &mut renamed)
    })
}

fn rewritten_in_form(
    text: &str,
    (begin, end): (&str, char),
    mut renamed: impl FnMut(&str) -> Option<String>,
) -> String {
    let mut parts = text.split(begin);
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        whole.push_str(begin);
        match part.split_once(end) {
            Some((target, after)) => {
                whole.push_str(&renamed(target).unwrap_or_else(|| target.to_owned()));
                whole.push(end);
                whole.push_str(after);
            }
            None => whole.push_str(part),
        }
    }
    whole
}

/// Splits a target into the file of the repository that it names, seen from `document`, and its anchor with `#`. `None` for addresses and for
/// anchors of the same page.
pub(crate) fn inside<'a>(document: &Path, target: &'a str) -> Option<(PathBuf, &'a str)> {
    let anchor_at = target.find('#').unwrap_or(target.len());
    let (file, anchor) = target.split_at(anchor_at);
    if file.is_empty() || file.contains("://") || file.starts_with("mailto:") {
        return None;
    }
    let folder = document.parent().unwrap_or(Path::new(""));
    Some((normal(&folder.join(file)), anchor))
}

/// Without `.` and `..`, as far as the path itself says.
pub(crate) fn normal(path: &Path) -> PathBuf {
    let mut whole = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if whole.file_name().is_some() => {
                whole.pop();
            }
            other => whole.push(other),
        }
    }
    whole
}

/// The way from the page `from` to the file `to`, both seen from the same folder.
pub(crate) fn way(from: &Path, to: &Path) -> String {
    let folder: Vec<_> = from.parent().unwrap_or(Path::new("")).components().collect();
    let goal: Vec<_> = to.components().collect();
    let shared = folder
        .iter()
        .zip(&goal)
        .take_while(|(one, other)| one == other)
        .count();
    let up = std::iter::repeat_n("..".to_owned(), folder.len() - shared);
    let down = goal
        .iter()
        .skip(shared)
        .map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::{inside, rewritten, way};
    use std::path::{Path, PathBuf};

    #[test]
    fn only_targets_are_replaced() {
        let text = "a [b](c.md) and ![d](e.png), (c.md), [f](http://g) <img src=\"c.md\"> [open](end";
        let seen = rewritten(text, |target| (target == "c.md").then(|| "new.md".to_owned()));
        assert_eq!(
            seen,
            "a [b](new.md) and ![d](e.png), (c.md), [f](http://g) <img src=\"new.md\"> [open](end"
        );
    }

    #[test]
    fn a_target_is_a_file_and_an_anchor() {
        let page = Path::new("docs/book/src/guide/index.md");
        let found = |target| inside(page, target);
        assert_eq!(
            found("../../../../SAFETY.md#rules"),
            Some((PathBuf::from("SAFETY.md"), "#rules"))
        );
        assert_eq!(
            found("./a.md"),
            Some((PathBuf::from("docs/book/src/guide/a.md"), ""))
        );
        assert_eq!(found("#here"), None);
        assert_eq!(found("https://example.org/a.md"), None);
        assert_eq!(found("mailto:a@example.org"), None);
    }

    #[test]
    fn ways_lead_up_and_down() {
        assert_eq!(way(Path::new("guide/a.md"), Path::new("guide/b.md")), "b.md");
        assert_eq!(
            way(Path::new("guide/a.md"), Path::new("repository/SAFETY.md")),
            "../repository/SAFETY.md"
        );
        assert_eq!(way(Path::new("a.md"), Path::new("guide/b.md")), "guide/b.md");
    }
}
