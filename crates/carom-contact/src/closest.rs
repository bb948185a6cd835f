//! The closest point of a piece of line or surface.

use carom_mesh::Vector;

use crate::domain::{Domain, Quadratic};

/// Newton steps; on pieces of moderate curvature four are enough, on straight ones one.
const MAX_STEPS: usize = 50;

/// A piece of line or surface s(ξ) at one ξ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Local<const D: usize> {
    /// s [m].
    pub point: Vector<D>,
    /// ∂s/∂ξ [m]; the second is zero for a line.
    pub tangents: [Vector<D>; 2],
    /// ∂²s/∂ξ², ∂²s/∂ξ∂η and ∂²s/∂η² [m].
    pub bends: [Vector<D>; 3],
}

/// A piece of line or surface over a reference domain.
pub(crate) trait Parametric<const D: usize> {
    /// Where ξ is.
    fn domain(&self) -> Domain;

    /// Whether s is affine.
    fn is_straight(&self) -> bool;

    /// What is at ξ.
    fn local(&self, xi: &[f64; 2]) -> Local<D>;

    /// ξ of the point closest to `x`, and what is there, from a start.
    ///
    /// Newton's method. Each step minimises the quadratic model of ½|x − s|² over the reference domain, exactly, and is shortened
    /// until the distance falls. So edges and corners need no cases of their own.
    fn closest_from(&self, x: &Vector<D>, start: [f64; 2]) -> ([f64; 2], Local<D>) {
        let (mut xi, mut at) = (start, self.local(&start));
        for _ in 0..MAX_STEPS {
            let Some(mut step) = self.domain().step(&xi, &at.model(x)) else { break };
            let change = step[0].abs().max(step[1].abs());
            let mut next = [xi[0] + step[0], xi[1] + step[1]];
            let mut there = self.local(&next);
            if !self.is_straight() && change > 1e-7 {
                let distance = (x - at.point).norm_squared();
                let mut halvings = 0;
                while (x - there.point).norm_squared() > distance && halvings < 30 {
                    step = step.map(|s| 0.5 * s);
                    next = [xi[0] + step[0], xi[1] + step[1]];
                    there = self.local(&next);
                    halvings += 1;
                }
            }
            (xi, at) = (next, there);
            if change < 1e-14 {
                break;
            }
        }
        (xi, at)
    }
}

impl<const D: usize> Local<D> {
    /// ∂/∂ξ of ½|x − s|² [m²].
    pub fn slope(&self, x: &Vector<D>) -> [f64; 2] {
        let d = x - self.point;
        self.tangents.map(|t| -d.dot(&t))
    }

    /// A convex quadratic model of ½|x − s|²: Newton's, with the curvature, where that is convex, otherwise that of Gauss and Newton.
    fn model(&self, x: &Vector<D>) -> Quadratic {
        let (d, t) = (x - self.point, &self.tangents);
        let metric = [t[0].norm_squared(), t[0].dot(&t[1]), t[1].norm_squared()];
        let mut bend = metric;
        for (own, by) in bend.iter_mut().zip(&self.bends) {
            *own -= d.dot(by);
        }
        if bend[0] <= 0.0 || (D == 3 && bend[0] * bend[2] - bend[1] * bend[1] <= 1e-6 * bend[0] * bend[2]) {
            bend = metric;
        }
        Quadratic { slope: self.slope(x), bend }
    }
}
