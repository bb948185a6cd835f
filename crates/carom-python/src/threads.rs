//! Work without the lock of Python, by the threads that this process has.
//!
//! A process that is forked has a copy of its parent's pool of threads, and none of the threads: who waits for them waits for ever. Where the
//! parent had used them, each thread of the child works alone.

use std::sync::atomic::{AtomicBool, Ordering};

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Whether this process may have started its threads.
static STARTED: AtomicBool = AtomicBool::new(false);
/// Whether it was forked from one that may have.
static FORKED: AtomicBool = AtomicBool::new(false);

/// How many threads share the work of this process from its first step on.
#[pyfunction]
pub fn thread_count(py: Python<'_>) -> usize {
    detached(py, carom_mesh::parallel::thread_count)
}

/// Has this process, if it is forked, do without the threads of its parent.
pub fn watch_forks(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let os = py.import("os")?;
    // Windows has no forks.
    if os.hasattr("register_at_fork")? {
        let call = PyDict::new(py);
        call.set_item("after_in_child", wrap_pyfunction!(forked, module)?)?;
        os.call_method("register_at_fork", (), Some(&call))?;
    }
    Ok(())
}

/// What the only thread that a child has begins with.
#[pyfunction]
fn forked() {
    if STARTED.load(Ordering::Relaxed) {
        FORKED.store(true, Ordering::Relaxed);
        work_alone();
    }
}

/// Does `work` without the lock of Python.
pub fn detached<R: Send>(py: Python<'_>, work: impl FnOnce() -> R + Send) -> R {
    mind_forks();
    py.detach(work)
}

/// Before work that threads may share: in a process that was forked this one works alone.
pub fn mind_forks() {
    STARTED.store(true, Ordering::Relaxed);
    if FORKED.load(Ordering::Relaxed) {
        work_alone();
    }
}

/// Makes this thread the only one of a pool, which is never given back.
fn work_alone() {
    // One that was a worker of the parent waits for nobody either: it takes back itself what nobody else takes.
    if rayon::current_thread_index().is_none() {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
        std::mem::forget(alone.expect("no thread is started, and this one is in no pool"));
    }
}
