//! Rows that may differ, each with its reason. The same list stands in `docs/status.md`.

/// Printed while the processor ran: its values have moved on since the stored copies were made.
const RUNNING: &str = "printed from a running processor; the stored images hold earlier values";
/// Printed from a save of the project that the corpus does not have.
const OTHER_SAVE: &str = "printed from another save of the project";

/// Part of the report's path, aspect, number of rows, reason.
const EXCEPTIONS: &[(&str, &str, usize, &str)] = &[
    ("cascading_timers_live", "values", 122, RUNNING),
    ("cascading_timers_live", "status", 6, RUNNING),
    ("cascading_timers_live", "displayed", 7, RUNNING),
    ("cascading_timers_live", "operands", 3, RUNNING),
    ("free_running_clock_bit_14_live", "values", 146, RUNNING),
    ("free_running_clock_bit_14_live", "status", 6, RUNNING),
    ("free_running_clock_bit_14_live", "displayed", 7, RUNNING),
    ("free_running_clock_bit_14_live", "operands", 2, RUNNING),
    ("free_running_clock_bit_14_live", "highlights", 12, RUNNING),
    ("rtc_bit_1_live", "highlights", 2, RUNNING),
    ("rtc_bit_1_live", "values", 165, RUNNING),
    ("rtc_bit_1_live", "status", 9, RUNNING),
    ("rtc_bit_1_live", "displayed", 8, RUNNING),
    ("rtc_bit_1_live", "operands", 2, RUNNING),
    ("single_timer_live", "values", 41, RUNNING),
    ("single_timer_live", "status", 1, RUNNING),
    ("single_timer_live", "displayed", 8, RUNNING),
    ("single_timer_live", "operands", 4, RUNNING),
    ("pressure_control", "processor", 1, OTHER_SAVE),
    ("pressure_control", "memory", 2, OTHER_SAVE),
    ("pressure_control", "values", 3, OTHER_SAVE),
    ("pressure_control", "comments", 1, OTHER_SAVE),
    ("pressure_control", "rungs", 2, OTHER_SAVE),
    ("pressure_control", "displayed", 9, OTHER_SAVE),
    ("pressure_control", "labels", 2, OTHER_SAVE),
    ("pressure_control", "boxes", 2, OTHER_SAVE),
    ("pressure_control", "operands", 3, OTHER_SAVE),
    ("traffic_light_6TON_orig", "comments", 6, OTHER_SAVE),
    ("traffic_light_6TON_orig", "rungs", 6, OTHER_SAVE),
    ("traffic_light_6TON_orig", "labels", 12, OTHER_SAVE),
    ("traffic_light_6TON_orig", "points", 6, OTHER_SAVE),
];

/// How many rows of an aspect may differ in a report, and why.
pub(crate) fn reason(report: &str, aspect: &str) -> Option<(usize, &'static str)> {
    EXCEPTIONS.iter().find(|e| report.contains(e.0) && e.1 == aspect).map(|e| (e.2, e.3))
}

/// Report and aspect of every exception.
pub(crate) fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    EXCEPTIONS.iter().map(|e| (e.0, e.1))
}
