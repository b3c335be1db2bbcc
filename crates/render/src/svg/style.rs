//! The style sheet of drawings.

/// Dark ink on white, as on paper.
macro_rules! light {
    () => {
        "--rung-wire:#1f3fae;--rung-ink:#111;--rung-soft:#555;--rung-paper:#fff;\
         --rung-symbol:#cdeccd;--rung-description:#fff6c4;--rung-comment:#fff6c4;--rung-title:#cdeccd;\
         --rung-on:#15803d;--rung-force:#b00020;--rung-note:#a04000;\
         --rung-inserted:#006d2c;--rung-deleted:#b00020;--rung-changed:#7a4b00;--rung-found:#6a1b9a"
    };
}

/// Light ink on black.
macro_rules! dark {
    () => {
        "--rung-wire:#8fb0ff;--rung-ink:#e8e8e8;--rung-soft:#a8a8a8;--rung-paper:#16181d;\
         --rung-symbol:#1f4a28;--rung-description:#45400f;--rung-comment:#37340f;--rung-title:#1f4a28;\
         --rung-on:#4ade80;--rung-force:#ff8a80;--rung-note:#ffb074;\
         --rung-inserted:#6ee7a0;--rung-deleted:#ff9c94;--rung-changed:#ffd27a;--rung-found:#d7a6ff"
    };
}

/// The style sheet, once for a page with drawings. Everything in it is below the class `rung`, so it
/// touches nothing else on a page. Paper is always light.
pub const STYLE: &str = concat!(
    ".rung{",
    light!(),
    ";display:block;font:13px \"DejaVu Sans Mono\",Consolas,Menlo,\"Liberation Mono\",monospace;fill:var(--rung-ink);",
    "background:var(--rung-paper)}",
    "@media (prefers-color-scheme:dark){.rung{",
    dark!(),
    "}}",
    "[data-theme=light] .rung{",
    light!(),
    "}[data-theme=dark] .rung{",
    dark!(),
    "}@media print{.rung,[data-theme] .rung{",
    light!(),
    "}}",
    ".rung text{white-space:pre}",
    ".rung a{text-decoration:none;cursor:pointer}",
    ".rung a:hover text,.rung a:focus text,.rung text a:hover{text-decoration:underline;fill:var(--rung-wire)}",
    ".rung path{fill:none;stroke:var(--rung-wire);stroke-width:1.4}",
    ".rung .rail{stroke-width:2}",
    ".rung .sign{stroke:var(--rung-ink);stroke-width:1.6}",
    ".rung .frame{stroke:var(--rung-ink);stroke-width:1.4}",
    ".rung .paper{fill:var(--rung-paper)}",
    ".rung rect.title{fill:var(--rung-title)}.rung rect.comment{fill:var(--rung-comment)}",
    ".rung rect.symbol{fill:var(--rung-symbol)}.rung rect.description{fill:var(--rung-description)}",
    ".rung .number,.rung .module,.rung .name{fill:var(--rung-soft)}",
    ".rung text.title,.rung .mnemonic,.rung text.symbol,.rung .edit,.rung .force,.rung .state{font-weight:bold}",
    ".rung .mnemonic{fill:var(--rung-wire)}",
    ".rung .note{fill:var(--rung-note);font-style:italic}",
    ".rung .force{fill:var(--rung-force)}.rung .state{fill:var(--rung-on)}",
    // What conducts is thick and filled, so that it shows without its colour too.
    ".rung .bar{fill:var(--rung-on);visibility:hidden}.rung .on>.bar{visibility:visible}",
    ".rung .on>.sign,.rung .on>.frame{stroke-width:2.6}",
    ".rung .w.on{stroke:var(--rung-on);stroke-width:3}",
    ".rung .forced-on>.sign,.rung .forced-off>.sign{stroke:var(--rung-force)}",
    ".rung .outline{fill:none;stroke-width:2}",
    ".rung .inserted>.outline{stroke:var(--rung-inserted)}",
    ".rung .deleted>.outline{stroke:var(--rung-deleted);stroke-dasharray:7 4}",
    ".rung .changed>.outline{stroke:var(--rung-changed);stroke-dasharray:2 3}",
    ".rung .found>.outline{stroke:var(--rung-found);stroke-width:3}",
);
