//! What every page of ours shares: its head with the policy that forbids all but its own style and script,
//! texts that stay texts, links to files beside it.

mod escape;
mod hash;

use std::io::{self, Write};

pub(crate) use escape::escape;

/// The look of all pages, below which each puts its own.
pub(crate) const STYLE: &str = include_str!("../../assets/report.css");

/// Writes all before what can be seen. Only this style and script may be in the page, whatever follows.
pub(crate) fn head(title: &str, style: &str, script: &str, out: &mut dyn Write) -> io::Result<()> {
    write!(
        out,
        "<!DOCTYPE html>\n<html lang=en>\n<head>\n<meta charset=utf-8>\n\
         <meta http-equiv=Content-Security-Policy content=\"default-src 'none'; style-src {}; script-src {}; \
         base-uri 'none'; form-action 'none'\">\n\
         <meta name=viewport content=\"width=device-width, initial-scale=1\">\n\
         <meta name=referrer content=no-referrer>\n<title>{}</title>\n<style>{style}</style>\n</head>\n<body>\n",
        hash::source(style),
        hash::source(script),
        escape(title)
    )
}

/// A file name as a link that can only be one: nothing in it can be a scheme, a folder or a mark.
pub(crate) fn relative(name: &str) -> String {
    let mut href = String::from("./");
    for byte in name.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'_' | b'.' => href.push(char::from(byte)),
            other => href.push_str(&format!("%{other:02X}")),
        }
    }
    href
}
