use super::control::CONTROL;
use super::{Bipotential, LocalContact, LocalSolver, polynomial};
use crate::{Vector, cone};

/// Every case by its closed form: separation, stick and slip. Slip is a linear equation for each direction in 2D and a
/// quartic for the direction in 3D. Where round-off lets no case fit, the fixed point is used.
///
/// In slip w_n = 0, r = r_n (1, μ d) and w_t = −s d with |d| = 1, r_n ≥ 0 and s ≥ 0, so that r_n = −b_n/(A_nn + μ A_nt·d).
/// What remains in 3D is that w_t has no part across d. In the angle of d that is a trigonometric polynomial of degree two.
/// In the tangent of half the angle it is a quartic [O. Bonnefon, G. Daviet, INRIA Technical Report RT-0406 (2011)].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Enumerative;

impl<const D: usize> LocalSolver<D> for Enumerative {
    #[inline]
    fn solve(contact: &LocalContact<D>, free: &Vector<D>, r: &Vector<D>, accuracy: f64) -> Vector<D> {
        if free[0] >= 0.0 {
            return Vector::zeros();
        }
        if let Some(inverse) = &contact.inverse {
            let stick = -(inverse * free);
            if cone::tangential_norm(&stick) <= contact.mu * stick[0] {
                return stick;
            }
        }
        let mut best = Best { contact, free, r: *r, error: f64::INFINITY };
        match D {
            1 => best.offer(&slip(contact, free, &Vector::zeros())),
            2 => {
                for sign in [-1.0, 1.0] {
                    best.offer(&slip(
                        contact,
                        free,
                        &Vector::from_fn(|k, _| if k == 1 { sign } else { 0.0 }),
                    ));
                }
            }
            _ => offer_slips_in_space(&mut best, r),
        }
        let scale = best.r.norm() + contact.rho * free.norm();
        if best.error <= CONTROL.round_off * scale {
            best.r
        } else {
            Bipotential::solve(contact, free, &best.r, accuracy)
        }
    }
}

/// The case that fits best.
struct Best<'a, const D: usize> {
    contact: &'a LocalContact<D>,
    free: &'a Vector<D>,
    r: Vector<D>,
    error: f64,
}

impl<const D: usize> Best<'_, D> {
    fn offer(&mut self, r: &Vector<D>) {
        let error = (self.contact.fixed_point(self.free, r) - r).norm();
        // A pull of r is no error that the fixed point sees as large: proj(r) = r is part of the law.
        if r[0] >= 0.0 && error < self.error {
            (self.r, self.error) = (*r, error);
        }
    }
}

/// The reaction in slip against the tangential direction `direction` of r_t.
#[inline]
fn slip<const D: usize>(contact: &LocalContact<D>, free: &Vector<D>, direction: &Vector<D>) -> Vector<D> {
    let mut r = direction * contact.mu;
    r[0] = 1.0;
    let along = contact.block.row(0).tr_dot(&r);
    r * (-free[0] / along)
}

/// Offers all slips of a contact in 3D: first the one near the guess `r`, and the others if it does not fit.
fn offer_slips_in_space<const D: usize>(best: &mut Best<'_, D>, r: &Vector<D>) {
    let (contact, free, mu) = (best.contact, best.free, best.contact.mu);
    let (a, b) = (&contact.block, free);
    // k[0] c + k[1] s + k[2] c² + k[3] s² + k[4] s c = 0 for d = (c, s).
    let k = [
        a[(0, 0)] * b[2] - b[0] * a[(2, 0)],
        b[0] * a[(1, 0)] - a[(0, 0)] * b[1],
        mu * (b[2] * a[(0, 1)] - b[0] * a[(2, 1)]),
        mu * (b[0] * a[(1, 2)] - b[1] * a[(0, 2)]),
        mu * (b[2] * a[(0, 2)] - b[1] * a[(0, 1)] - b[0] * (a[(2, 2)] - a[(1, 1)])),
    ];
    let offer = |best: &mut Best<'_, D>, c: f64, s: f64| {
        let mut direction = Vector::zeros();
        (direction[1], direction[2]) = (c, s);
        best.offer(&slip(contact, free, &direction));
    };
    let scale = contact.rho * free.norm();
    if let Some((c, s)) = near_root(&k, r[1], r[2]) {
        offer(best, c, s);
        if best.error <= CONTROL.round_off * (scale + best.r.norm()) {
            return;
        }
    }
    // The two halves of the circle, c ≥ 0 and c ≤ 0, each with t = tan(θ/2) in [−1, 1] from its middle.
    for half in [1.0, -1.0] {
        let (k0, k1) = (half * k[0], half * k[1]);
        let quartic = [k0 + k[2], 2.0 * (k1 + k[4]), 4.0 * k[3] - 2.0 * k[2], 2.0 * (k1 - k[4]), k[2] - k0];
        polynomial::visit_roots(quartic, |t| {
            let scale = half / (1.0 + t * t);
            offer(best, (1.0 - t * t) * scale, 2.0 * t * scale);
        });
    }
}

/// Newton's method on the angle, from the direction (c, s), which need not be of length 1.
fn near_root(k: &[f64; 5], c: f64, s: f64) -> Option<(f64, f64)> {
    let length = c.hypot(s);
    if length == 0.0 {
        return None;
    }
    let (mut c, mut s) = (c / length, s / length);
    for _ in 0..8 {
        let value = k[0] * c + k[1] * s + k[2] * c * c + k[3] * s * s + k[4] * s * c;
        let slope = k[1] * c - k[0] * s + 2.0 * (k[3] - k[2]) * s * c + k[4] * (c * c - s * s);
        let turn = -value / slope;
        if turn.is_nan() || turn.abs() > 1.0 {
            return None;
        }
        // A rotation by 2 atan(turn/2), free of trigonometric functions, and the same to second order.
        let (half, scale) = (0.5 * turn, 1.0 / (1.0 + 0.25 * turn * turn));
        let (cosine, sine) = ((1.0 - half * half) * scale, turn * scale);
        (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        if turn.abs() < 1e-9 {
            // Quadratic convergence: this turn was exact to round-off.
            let length = c.hypot(s);
            return Some((c / length, s / length));
        }
    }
    None
}
