use crate::Motion;

/// What the supports of a motion are called in the history: its body and set, and a number where that is not unique.
pub(super) fn support_name<const D: usize>(before: &[Motion<D>], body: &str, on: &str) -> String {
    let plain = if on.is_empty() { body.to_string() } else { format!("{body}.{on}") };
    let taken = |name: &str| before.iter().any(|m| m.name == name);
    let numbered = (2..).map(|k| format!("{plain}.{k}"));
    std::iter::once(plain.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(plain)
}
