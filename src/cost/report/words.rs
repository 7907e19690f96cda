//! Rows of a knob → what one more decimal costs, in words.

use crate::cost::errors::Metric;
use crate::cost::sweep::Row;

/// Errors that differ by less than this share are one and the same.
const SAME: f64 = 0.02;

/// A sentence or two on a knob whose rows go from coarse to fine.
pub fn one_more_decimal(metric: Metric, rows: &[&Row]) -> String {
    let measured: Vec<(&Row, f64)> =
        rows.iter().filter_map(|row| Some((*row, row.alone.as_ref()?.get(metric)?))).collect();
    let (Some(&(first, start)), Some(&(best, least))) =
        (measured.first(), measured.iter().min_by(|a, b| a.1.total_cmp(&b.1)))
    else {
        return "There is nothing in the windows to measure it by.".to_owned();
    };
    let worst = measured.iter().map(|(_, error)| *error).fold(0.0, f64::max);
    if worst - least <= SAME * worst {
        let text =
            if worst == 0.0 { "no error at all".to_owned() } else { format!("an error of {}", metric.text(worst)) };
        let (fast, slow) = spread(&measured);
        return format!(
            "It makes no difference here: every value has {text}; times lie between {fast:.0} and {slow:.0} ms."
        );
    }
    let tenth = measured.iter().find(|(_, error)| *error <= start / 10.0);
    let step = |row: &Row, error: f64| format!("{} at {} ({:.0} ms)", metric.text(error), row.value, row.times.median);
    let times = |row: &Row| ratio(row.times.median, first.times.median);
    match tenth {
        Some((row, error)) => {
            format!("One more decimal: from {} to {}: {} the time.", step(first, start), step(row, *error), times(row))
        }
        None if least < start => format!(
            "One more decimal is not to be had: from {} the best is {}, {} less error for {} the time.",
            step(first, start),
            step(best, least),
            factor(start / least.max(f64::MIN_POSITIVE)),
            times(best)
        ),
        None => format!("The coarsest value is the best: {}.", step(first, start)),
    }
}

fn spread(measured: &[(&Row, f64)]) -> (f64, f64) {
    let times = measured.iter().map(|(row, _)| row.times.median);
    (times.clone().fold(f64::INFINITY, f64::min), times.fold(0.0, f64::max))
}

fn ratio(time: f64, base: f64) -> String {
    factor(time / base)
}

fn factor(factor: f64) -> String {
    match factor {
        f if f >= 9.95 => format!("{f:.0} times"),
        f if f >= 1.05 => format!("{f:.1} times"),
        f if f >= 0.95 => "the same as".to_owned(),
        f => format!("{f:.2} times"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::bench::{Setting, Times};
    use crate::cost::errors::Errors;
    use crate::cost::knobs::FINE;
    use crate::cost::sweep::Kind;

    fn row(value: &str, error: f64, ms: f64) -> Row {
        Row {
            kind: Kind::Knob,
            knob: "k",
            value: value.to_owned(),
            setting: Setting::of(FINE),
            alone: Some(Errors { light: error, ..Errors::default() }),
            errors: Errors::default(),
            times: Times { median: ms, least: ms, most: ms, repeats: 3, passes: Vec::new() },
        }
    }

    fn say(rows: &[Row]) -> String {
        one_more_decimal(Metric::Light, &rows.iter().collect::<Vec<_>>())
    }

    #[test]
    fn a_decimal_is_a_tenth_of_the_error() {
        let rows = [row("1", 0.1, 10.0), row("4", 0.03, 20.0), row("16", 0.01, 60.0), row("64", 0.001, 900.0)];
        assert_eq!(
            say(&rows),
            "One more decimal: from 10.0 % at 1 (10 ms) to 1.00 % at 16 (60 ms): 6.0 times the time."
        );
        let text = "One more decimal is not to be had: from 10.0 % at 1 (10 ms) the best is 3.00 % at 4 (20 ms), \
                    3.3 times less error for 2.0 times the time.";
        assert_eq!(say(&rows[..2]), text);
    }

    #[test]
    fn knobs_that_do_nothing_are_told_so() {
        assert!(say(&[row("a", 0.01, 10.0), row("b", 0.01, 30.0)]).starts_with("It makes no difference here"));
        assert!(say(&[row("a", 0.0, 1.0)]).contains("no error at all"));
        assert!(say(&[]).starts_with("There is nothing"));
    }
}
