//! A long-running program and its output.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};

use super::patience::PATIENCE;

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
        self.lines_to(wanted).pop().unwrap_or_default()
    }

    /// All lines up to the next one that contains `wanted`.
    #[track_caller]
    pub(crate) fn lines_to(&self, wanted: &str) -> Vec<String> {
        let mut said = vec![];
        while let Ok(line) = self.lines.recv_timeout(PATIENCE) {
            let is_wanted = line.contains(wanted);
            said.push(line);
            if is_wanted {
                return said;
            }
        }
        panic!("nothing with `{wanted}` was said, but {said:#?}");
    }

    /// The next lines that contain each of these, in any order, since two streams have none.
    #[track_caller]
    pub(crate) fn lines<const COUNT: usize>(&self, wanted: [&str; COUNT]) -> [String; COUNT] {
        let mut found = wanted.map(|_| None);
        while found.iter().any(Option::is_none) {
            let Ok(line) = self.lines.recv_timeout(PATIENCE) else {
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
