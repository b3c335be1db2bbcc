//! A real Chromium without a window, driven through WebDriver, for tests of pages.
//!
//! Every call blocks, so that a test reads from top to bottom:
//!
//! ```no_run
//! use rungs_tests::browser::Browser;
//!
//! let Some(browser) = Browser::start() else { return };
//! browser.open(std::path::Path::new("/tmp/page.html"));
//! assert_eq!(browser.text("h1"), "conveyor.RSS");
//! assert_eq!(browser.complaints(), Vec::<String>::new());
//! ```
//!
//! Every failure panics with what was asked for: this is for tests only. `cargo xtask setup` installs
//! what is needed.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use fantoccini::error::CmdError;
use fantoccini::wd::{Capabilities, WebDriverCompatibleCommand};
use fantoccini::{Client, ClientBuilder, Locator};
use hyper_util::client::legacy::connect::HttpConnector;
use serde_json::{Value, json};
use tokio::runtime::Runtime;

/// Set to 1, tests that need a browser say that they are skipped.
pub const NO_BROWSER: &str = "RUNGS_NO_BROWSER";

/// How long [`Browser::wait_for`] waits, and how long a page may take to load.
const PATIENCE: Duration = Duration::from_secs(20);

/// Names under which systems install Chromium.
const CHROMIUM: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Keys without a character, as WebDriver spells them.
pub mod key {
    /// Escape.
    pub const ESCAPE: &str = "\u{E00C}";
    /// Enter.
    pub const ENTER: &str = "\u{E007}";
    /// Arrow up.
    pub const UP: &str = "\u{E013}";
    /// Arrow down.
    pub const DOWN: &str = "\u{E015}";
    /// Arrow left.
    pub const LEFT: &str = "\u{E012}";
    /// Arrow right.
    pub const RIGHT: &str = "\u{E014}";
    /// Control, held down until [`NULL`].
    pub const CONTROL: &str = "\u{E009}";
    /// All keys are up again.
    pub const NULL: &str = "\u{E000}";
    /// Tab.
    pub const TAB: &str = "\u{E004}";
}

/// A browser with one page.
pub struct Browser {
    runtime: Runtime,
    /// Taken out when it is closed.
    client: Option<Client>,
    driver: Child,
}

impl Browser {
    /// Starts a browser, 1280 x 900. `None`, with a plain line, when `RUNGS_NO_BROWSER=1`.
    ///
    /// # Panics
    /// When there is none, so that a test never passes without having looked.
    #[must_use]
    pub fn start() -> Option<Browser> {
        if std::env::var_os(NO_BROWSER).is_some_and(|value| value == "1") {
            println!("skipped: {NO_BROWSER}=1");
            return None;
        }
        let chromium = CHROMIUM.into_iter().find_map(found);
        let (Some(driver), Some(chromium)) = (found("chromedriver"), chromium) else {
            panic!(
                "chromium and chromedriver are needed: `cargo xtask setup` installs them where apt-get is; \
                 {NO_BROWSER}=1 leaves these tests out"
            );
        };
        let (driver, port) = launch(&driver);
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .unwrap_or_else(|error| panic!("no runtime: {error}"));
        let mut browser = Browser { runtime, client: None, driver };
        let capabilities = json!({
            "goog:chromeOptions": {
                "binary": chromium,
                // A container has no other sandbox to offer, and little shared memory.
                "args": ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu",
                    "--window-size=1280,900", "--force-device-scale-factor=1"],
            },
            "goog:loggingPrefs": {"browser": "ALL"},
        });
        let Value::Object(capabilities) = capabilities else { return None };
        let capabilities: Capabilities = capabilities;
        let client = browser.runtime.block_on(
            ClientBuilder::new(HttpConnector::new())
                .capabilities(capabilities)
                .connect(&format!("http://127.0.0.1:{port}")),
        );
        browser.client = Some(client.unwrap_or_else(|error| panic!("no browser session: {error}")));
        Some(browser)
    }

    fn client(&self) -> &Client {
        self.client.as_ref().unwrap_or_else(|| panic!("the browser is closed"))
    }

    fn ask<T>(&self, what: &str, answer: impl Future<Output = Result<T, CmdError>>) -> T {
        self.runtime.block_on(answer).unwrap_or_else(|error| panic!("{what}: {error}"))
    }

    /// Opens a file.
    pub fn open(&self, path: &Path) {
        let whole = path.canonicalize().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let url = url::Url::from_file_path(&whole).unwrap_or_else(|()| panic!("{}: no URL", whole.display()));
        self.go(url.as_str());
    }

    /// Goes to an address.
    pub fn go(&self, url: &str) {
        self.ask(url, self.client().goto(url));
    }

    /// The address shown, fragment included.
    #[must_use]
    pub fn url(&self) -> String {
        self.ask("the address", self.client().current_url()).to_string()
    }

    /// The Back button.
    pub fn back(&self) {
        self.ask("back", self.client().back());
    }

    /// Runs the body of a function and gives what it returns.
    pub fn run(&self, script: &str) -> Value {
        self.ask(script, self.client().execute(script, Vec::new()))
    }

    /// Whether an expression is true.
    #[must_use]
    pub fn is(&self, expression: &str) -> bool {
        self.run(&format!("return !!({expression})")) == Value::Bool(true)
    }

    /// A number an expression gives.
    #[must_use]
    pub fn number(&self, expression: &str) -> f64 {
        let value = self.run(&format!("return Number({expression})"));
        value.as_f64().unwrap_or_else(|| panic!("{expression} is {value}"))
    }

    /// Waits until an expression is true.
    ///
    /// # Panics
    /// When that takes too long.
    pub fn wait_for(&self, expression: &str) {
        let start = Instant::now();
        while !self.is(expression) {
            if start.elapsed() >= PATIENCE {
                let page = self.run("return location.href + '\\n' + document.body.innerText.slice(0, 2000)");
                let page = page.as_str().unwrap_or_default().to_owned();
                panic!("{expression} did not become true\n{page}\n{}", self.complaints().join("\n"));
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The visible text of the first element a selector finds.
    #[must_use]
    pub fn text(&self, selector: &str) -> String {
        let element = self.ask(selector, self.client().find(Locator::Css(selector)));
        self.ask(selector, element.text())
    }

    /// Clicks on the first element a selector finds, as a person would: it must be visible.
    pub fn click(&self, selector: &str) {
        // Bars that stay at the top would cover what is scrolled just into sight.
        self.run(&format!("document.querySelector({})?.scrollIntoView({{block: 'center'}})", json!(selector)));
        let element = self.ask(selector, self.client().find(Locator::Css(selector)));
        self.ask(selector, element.click());
    }

    /// Types into whatever has the focus; see [`key`] for keys without a character.
    pub fn keys(&self, keys: &str) {
        let element = self.ask("the focus", self.client().active_element());
        self.ask("keys", element.send_keys(keys));
    }

    /// Makes the window this large; the page is as wide.
    pub fn resize(&self, width: u32, height: u32) {
        self.ask("the size", self.client().set_window_size(width, height));
    }

    /// Tells pages that the system has a dark theme, or a light one.
    pub fn dark(&self, dark: bool) {
        let value = if dark { "dark" } else { "light" };
        let features = json!([{"name": "prefers-color-scheme", "value": value}]);
        self.tell("Emulation.setEmulatedMedia", json!({"features": features}));
    }

    /// Shows pages as paper would show them, or as a screen again.
    pub fn print(&self, paper: bool) {
        self.tell("Emulation.setEmulatedMedia", json!({"media": if paper { "print" } else { "" }}));
    }

    /// Makes everything larger, as a person does with Ctrl and +; the page becomes narrower by it.
    pub fn zoom(&self, width: u32, height: u32, factor: f64) {
        let (width, height) = (f64::from(width) / factor, f64::from(height) / factor);
        let size =
            json!({"width": width as u32, "height": height as u32, "deviceScaleFactor": factor, "mobile": false});
        self.tell("Emulation.setDeviceMetricsOverride", size);
    }

    /// Ends [`Browser::zoom`].
    pub fn no_zoom(&self) {
        self.tell("Emulation.clearDeviceMetricsOverride", json!({}));
    }

    /// A command of Chromium's own protocol.
    fn tell(&self, command: &'static str, parameters: Value) {
        self.ask(command, self.client().issue_cmd(Told { command, parameters }));
    }

    /// Saves what is visible as a PNG file in `target/screenshots`, for people to look at.
    pub fn screenshot(&self, name: &str) -> PathBuf {
        let bytes = self.ask("a picture", self.client().screenshot());
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/screenshots");
        let path = folder.join(format!("{name}.png"));
        let written = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&path, bytes));
        written.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        path
    }

    /// What the browser complained about since the last call: errors, warnings, violations of the
    /// page's own content security policy.
    #[must_use]
    pub fn complaints(&self) -> Vec<String> {
        let log = self.ask("the log", self.client().issue_cmd(Log));
        let lines = log.as_array().cloned().unwrap_or_default();
        let bad = lines.iter().filter(|line| matches!(line["level"].as_str(), Some("SEVERE" | "WARNING")));
        bad.map(|line| line["message"].as_str().unwrap_or_default().to_owned()).collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Closing the session ends Chromium; ending the driver alone would leave it behind.
        if let Some(client) = self.client.take() {
            let _ = self.runtime.block_on(async { tokio::time::timeout(PATIENCE, client.close()).await });
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

/// A program on the search path.
fn found(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// Starts the driver on a port it chooses itself and tells.
fn launch(driver: &Path) -> (Child, u16) {
    let child = Command::new(driver).arg("--port=0").stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
    let mut child = child.unwrap_or_else(|error| panic!("{}: {error}", driver.display()));
    let out = child.stdout.take().unwrap_or_else(|| panic!("{} says nothing", driver.display()));
    let mut lines = BufReader::new(out).lines();
    while let Some(Ok(line)) = lines.next() {
        let Some((_, rest)) = line.split_once("started successfully on port ") else { continue };
        if let Ok(port) = rest.trim_end_matches('.').parse() {
            // Reading on keeps the driver from stopping at a full pipe.
            std::thread::spawn(move || lines.map_while(Result::ok).for_each(drop));
            return (child, port);
        }
    }
    let _ = child.kill();
    let _ = child.wait();
    panic!("{} did not tell its port", driver.display());
}

/// Chromium's own command for its console.
#[derive(Debug)]
struct Log;

impl WebDriverCompatibleCommand for Log {
    fn endpoint(&self, base: &url::Url, session: Option<&str>) -> Result<url::Url, url::ParseError> {
        base.join(&format!("session/{}/se/log", session.unwrap_or_default()))
    }

    fn method_and_body(&self, _: &url::Url) -> (http::Method, Option<String>) {
        (http::Method::POST, Some(json!({"type": "browser"}).to_string()))
    }
}

/// A command that WebDriver hands on to Chromium.
#[derive(Debug)]
struct Told {
    command: &'static str,
    parameters: Value,
}

impl WebDriverCompatibleCommand for Told {
    fn endpoint(&self, base: &url::Url, session: Option<&str>) -> Result<url::Url, url::ParseError> {
        base.join(&format!("session/{}/goog/cdp/execute", session.unwrap_or_default()))
    }

    fn method_and_body(&self, _: &url::Url) -> (http::Method, Option<String>) {
        (http::Method::POST, Some(json!({"cmd": self.command, "params": self.parameters}).to_string()))
    }
}
