use std::sync::OnceLock;
use std::time::Instant;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

/// Rows of the matrices whose product is timed: as large as the larger supernodes.
const ROWS: usize = 192;
/// Share of the rate of that product which a sparse factor reaches (measured: 0.3 to 0.7).
const SHARE: f64 = 0.3;

/// Multiplications per second in a sparse factorisation on this machine, rather too few than too many. Timed once, in a few
/// milliseconds.
pub(crate) fn multiplications_per_second() -> f64 {
    static SPEED: OnceLock<f64> = OnceLock::new();
    *SPEED.get_or_init(|| {
        let a = Mat::from_fn(ROWS, ROWS, |i, j| 1.0 + (i + 2 * j) as f64);
        let mut product = Mat::zeros(ROWS, ROWS);
        // The first time memory is fetched.
        let times = [(); 2].map(|()| {
            let start = Instant::now();
            matmul(&mut product, Accum::Replace, &a, &a, 1.0, Par::Seq);
            start.elapsed().as_secs_f64()
        });
        SHARE * (ROWS * ROWS * ROWS) as f64 / times[0].min(times[1]).max(1e-6)
    })
}
