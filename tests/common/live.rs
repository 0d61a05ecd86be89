//! A long-running program and its output.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// The longest wait for an expected line.
const PATIENCE: Duration = Duration::from_secs(20);

/// A process that is killed when this is dropped.
pub(crate) struct Live {
    child: Child,
    lines: Receiver<String>,
}

impl Live {
    /// Starts `okoshi` in a folder.
    pub(crate) fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_okoshi"))
            .args(arguments)
            .current_dir(folder)
            .env("NO_COLOR", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let (sender, lines) = channel();
        let streams: [Box<dyn Read + Send>; 2] = [
            Box::new(child.stdout.take().expect("stdout")),
            Box::new(child.stderr.take().expect("stderr")),
        ];
        for stream in streams {
            let sender = sender.clone();
            std::thread::spawn(move || {
                for line in BufReader::new(stream).lines().map_while(Result::ok) {
                    let _ = sender.send(line);
                }
            });
        }
        Self { child, lines }
    }

    /// The next line that contains `wanted`.
    #[track_caller]
    pub(crate) fn line(&self, wanted: &str) -> String {
        let end = Instant::now() + PATIENCE;
        let mut said = vec![];
        while let Ok(line) = self
            .lines
            .recv_timeout(end.saturating_duration_since(Instant::now()))
        {
            if line.contains(wanted) {
                return line;
            }
            said.push(line);
        }
        panic!("nothing with `{wanted}` was said, but {said:#?}");
    }

    /// The next lines that contain each of these, in any order, since two streams have none.
    #[track_caller]
    pub(crate) fn lines<const COUNT: usize>(&self, wanted: [&str; COUNT]) -> [String; COUNT] {
        let end = Instant::now() + PATIENCE;
        let mut found = wanted.map(|_| None);
        while found.iter().any(Option::is_none) {
            let left = end.saturating_duration_since(Instant::now());
            let Ok(line) = self.lines.recv_timeout(left) else {
                panic!("of {wanted:?} only {found:?} were said");
            };
            for (found, wanted) in found.iter_mut().zip(wanted) {
                if found.is_none() && line.contains(wanted) {
                    *found = Some(line.clone());
                }
            }
        }
        found.map(Option::unwrap_or_default)
    }

    /// All lines that come within a time.
    pub(crate) fn during(&self, time: Duration) -> Vec<String> {
        let end = Instant::now() + time;
        let next = || {
            self.lines
                .recv_timeout(end.saturating_duration_since(Instant::now()))
        };
        std::iter::from_fn(|| next().ok()).collect()
    }

    /// Kills it, like a power cut.
    pub(crate) fn kill(mut self) -> Vec<String> {
        let _ = self.child.kill();
        let _ = self.child.wait();
        let mut lines = vec![];
        while let Ok(line) = self.lines.recv_timeout(PATIENCE) {
            lines.push(line);
        }
        lines
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
