//! Contact problems without a search of carom.

use std::ffi::{c_char, c_void};

use super::books::carom_report;
use super::setup::product;
use super::{carom_solver, carom_status};
use crate::compliance::{Columns, Compliance, condensed};
use crate::friction::{Method, solve};
use crate::memory::{array, numbers, one, text, write, write_one};
use crate::status::{Failure, guarded};

/// Find reactions r and motions w = W r + q of contacts that obey the laws of Signorini and Coulomb. Component 0 of a contact vector is normal.
#[repr(C)]
#[allow(non_camel_case_types)]
pub struct carom_problem {
    /// Components of a contact vector: 1, 2 or 3.
    pub dimension: usize,
    /// How many contacts there are, n.
    pub contact_count: usize,
    /// W [m/N], symmetric and positive semidefinite, shape [n dimension][n dimension]; of its two halves that above the diagonal counts.
    pub compliance: *const f64,
    /// q [m], the motions without reactions, shape [n][dimension].
    pub motion: *const f64,
    /// Coulomb's coefficients, shape [n].
    pub friction: *const f64,
}

/// How a contact problem is solved.
#[repr(C)]
#[allow(non_camel_case_types)]
pub struct carom_method {
    /// The name of the solver; null is "auto".
    pub solver: *const c_char,
    /// Relative residual at which it is solved; 0 is 1e-12.
    pub tolerance: f64,
    /// Iterations after which it fails; 0 is 10000.
    pub max_iterations: usize,
}

/// A map from reactions to forces by columns: H of carom_contact_map, or your own.
#[repr(C)]
#[allow(non_camel_case_types)]
pub struct carom_map {
    /// How many unknowns there are.
    pub unknown_count: usize,
    /// How many columns.
    pub column_count: usize,
    /// Where each column starts, and the end of the last, shape [column_count + 1].
    pub starts: *const usize,
    /// The unknowns of the entries, from 0, shape [starts[column_count]].
    pub unknowns: *const i32,
    /// Their values, of the same shape.
    pub values: *const f64,
}

/// Solves a contact problem. reactions [N], shape [n][dimension], are a guess before and the answer after; zeros are a guess. method may be null, and report too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_friction_solve(
    problem: *const carom_problem,
    method: *const carom_method,
    reactions: *mut f64,
    report: *mut carom_report,
) -> carom_status {
    // SAFETY: the promises of the header.
    guarded(|| unsafe {
        let problem = one("problem", problem)?;
        let method = match method.is_null() {
            true => Method::new("auto", 0.0, 0)?,
            false => named(one("method", method)?)?,
        };
        let count = problem.contact_count;
        let size = product("motion", count, problem.dimension)?;
        let w = numbers("compliance", problem.compliance, product("compliance", size, size)?)?;
        let q = numbers("motion", problem.motion, size)?;
        let mu = numbers("friction", problem.friction, count)?;
        let guess = numbers("reactions", reactions, size)?.to_vec();
        let (found, said) = match problem.dimension {
            1 => solve::<1>([w, q, mu], &guess, &method)?,
            2 => solve::<2>([w, q, mu], &guess, &method)?,
            3 => solve::<3>([w, q, mu], &guess, &method)?,
            other => return Err(Failure::invalid(format!("dimension is {other}; must be 1, 2 or 3"))),
        };
        write("reactions", &found, reactions, size)?;
        if report.is_null() { Ok(()) } else { write_one("report", (&said).into(), report) }
    })
}

unsafe fn named(method: &carom_method) -> Result<Method, Failure> {
    // SAFETY: the caller's promise.
    let name = if method.solver.is_null() { "auto" } else { unsafe { text("solver", method.solver) }? };
    Method::new(name, method.tolerance, method.max_iterations)
}

/// Writes W = H^T K^-1 H [m/N], shape [column_count][column_count], by a solver of K.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_friction_condense(
    map: *const carom_map,
    solver: carom_solver,
    context: *mut c_void,
    compliance: *mut f64,
) -> carom_status {
    // SAFETY: the promises of the header.
    guarded(|| unsafe {
        let map = one("map", map)?;
        let columns = columns(map)?;
        let w = condensed(&columns, &Compliance::new(solver, context, map.unknown_count))?;
        write("compliance", &w, compliance, w.len())
    })
}

unsafe fn columns(map: &carom_map) -> Result<Columns, Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        let starts = array("starts", map.starts, map.column_count.saturating_add(1))?;
        if starts[0] != 0 || starts.windows(2).any(|s| s[0] > s[1]) {
            return Err(Failure::invalid("starts must begin with 0 and ascend"));
        }
        let entries = starts[map.column_count];
        let given = array("unknowns", map.unknowns, entries)?;
        let values = numbers("values", map.values, entries)?.to_vec();
        let number = |(k, &u): (usize, &i32)| match usize::try_from(u) {
            Ok(u) if u < map.unknown_count => Ok(u),
            _ => Err(Failure::invalid(format!(
                "unknowns[{k}] is {u}, and there are {}; they are numbered from 0",
                map.unknown_count
            ))),
        };
        let unknowns = given.iter().enumerate().map(number).collect::<Result<_, _>>()?;
        Ok(Columns { starts: starts.to_vec(), unknowns, values })
    }
}
