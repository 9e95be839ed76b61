//! The name that was probably meant.

/// The candidate that is nearest to a word, if one is near enough: at most one
/// edit in three letters, exchanged neighbours being one edit. One that differs in case alone
/// is the nearest.
///
/// Among equally near ones the first is taken.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let same = |candidate: &&&str| candidate.eq_ignore_ascii_case(word);
    if let Some(same) = candidates.iter().find(same) {
        return Some(same);
    }
    let word: Vec<char> = word.chars().collect();
    let allowed = (word.len() / 3).max(1);
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let letters: Vec<char> = candidate.chars().collect();
        if letters.len().abs_diff(word.len()) > allowed {
            continue;
        }
        let distance = edits(&word, &letters);
        if distance > allowed || distance >= word.len().max(letters.len()) {
            continue;
        }
        if best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Insertions, deletions, replacements and exchanges of neighbours that turn one
/// word into another (Damerau's distance, without edits inside an exchange).
fn edits(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut next = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = row[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            next[j] = replaced.min(row[j] + 1).min(next[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                next[j] = next[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut row, next);
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_misspelt_name_is_recognised_and_a_stranger_is_not() {
        let names = ["L1", "theta", "stiffness", "g"];
        assert_eq!(nearest("L9", names), Some("L1"));
        assert_eq!(nearest("tehta", names), Some("theta"));
        assert_eq!(nearest("stifness", names), Some("stiffness"));
        assert_eq!(nearest("G", names), Some("g"));
        assert_eq!(nearest("Q1", ["L1", "q1"]), Some("q1"));
        assert_eq!(nearest("SIN", ["min", "sin"]), Some("sin"));
        assert_eq!(nearest("x", names), None);
        assert_eq!(nearest("damping", names), None);
    }
}
