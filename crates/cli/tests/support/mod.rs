//! Starting the command as a user does.
#![allow(dead_code)] // every test file uses its own part

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the workspace.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs `rungs` in a folder.
pub(crate) fn rungs_in(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rungs"))
        .current_dir(folder)
        .args(arguments)
        .env_remove("NO_COLOR")
        .output()
        .expect("the command starts")
}

/// The examples, and `rungs` run among them.
pub(crate) mod among_examples {
    use super::{Output, PathBuf, root, rungs_in};

    pub(crate) fn examples() -> PathBuf {
        root().join("examples")
    }

    pub(crate) fn rungs(arguments: &[&str]) -> Output {
        rungs_in(&examples(), arguments)
    }

    /// What it says on success.
    pub(crate) fn text(arguments: &[&str]) -> String {
        let output = rungs(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("text")
    }
}

/// `rungs` run in the folder of the workspace.
pub(crate) mod at_root {
    use super::{Output, root, rungs_in};

    pub(crate) fn rungs(arguments: &[&str]) -> Output {
        rungs_in(&root(), arguments)
    }

    pub(crate) fn text(bytes: &[u8]) -> String {
        String::from_utf8(bytes.to_vec()).expect("text")
    }
}

/// `rungs serve` as a process of its own; it ends with the value.
pub(crate) mod served {
    use std::io::{BufRead, BufReader};
    use std::net::{Ipv4Addr, SocketAddr};
    use std::path::Path;
    use std::process::{Child, Command, Stdio};

    pub(crate) struct Server {
        child: Child,
        /// Where it listens, as somebody on this machine reaches it.
        pub(crate) at: SocketAddr,
        /// The token it wants, if it wants one.
        pub(crate) token: Option<String>,
    }

    impl Server {
        /// Serves a program on a port the system chooses unless the arguments name one.
        pub(crate) fn start(program: &Path, arguments: &[&str]) -> Server {
            let mut command = Command::new(env!("CARGO_BIN_EXE_rungs"));
            command.arg("serve").arg(program);
            if !arguments.contains(&"--port") {
                command.args(["--port", "0"]);
            }
            let child = command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
            let mut child = child.expect("the command starts");
            let mut line = String::new();
            let out = child.stdout.take().expect("its output");
            BufReader::new(out).read_line(&mut line).expect("the address of the page");
            let rest = line.trim().strip_prefix("http://").unwrap_or_else(|| panic!("no address: {line}"));
            let (at, rest) = rest.split_once('/').expect("a page");
            let token = rest.strip_prefix("?token=").map(str::to_owned);
            let bound: SocketAddr = at.parse().expect("an address");
            let ip = if bound.ip().is_unspecified() { Ipv4Addr::LOCALHOST.into() } else { bound.ip() };
            Server { child, at: SocketAddr::new(ip, bound.port()), token }
        }

        /// Number of the process.
        pub(crate) fn id(&self) -> u32 {
            self.child.id()
        }

        /// Ends it at once, without a word: `kill -9`.
        pub(crate) fn kill(mut self) {
            self.end();
        }

        fn end(&mut self) {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }

    impl Drop for Server {
        fn drop(&mut self) {
            self.end();
        }
    }
}
