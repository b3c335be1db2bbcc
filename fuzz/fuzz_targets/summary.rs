//! The property set.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::payloads(&[rss::StreamKind::SummaryInformation]), rungs_fuzz::check::summary);
