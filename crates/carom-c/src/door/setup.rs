//! What there is and what may touch what.

use std::ffi::{c_char, c_int};

use serde_json::{Value, json};

use super::carom_status;
use super::contact::carom_contact;
use crate::handle::{Handle, give, take};
use crate::memory::{array, numbers, one, text};
use crate::setup::Setup;
use crate::status::{Failure, guarded};

/// Bodies, obstacles and what may touch what, as they are described piece by piece.
#[allow(non_camel_case_types)]
pub struct carom_setup(Handle<Setup>);

impl carom_setup {
    /// Does something with a setup, and says how that ended.
    unsafe fn change(setup: *mut Self, act: impl FnOnce(&mut Setup) -> Result<(), Failure>) -> carom_status {
        // SAFETY: the caller's promise.
        guarded(|| unsafe { one("setup", setup) }?.0.with("setup", act))
    }
}

/// A count times another, or why not.
pub(super) fn product(name: &str, a: usize, b: usize) -> Result<usize, Failure> {
    a.checked_mul(b)
        .ok_or_else(|| Failure::invalid(format!("{name} cannot have {a} × {b} entries; check the counts")))
}

/// Begins to describe contact. dimension is 2 or 3; points [m] has the places of all nodes without deformation, shape [point_count][dimension]. Nodes are numbered
/// from 0. Free what is written to setup with carom_setup_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_new(
    dimension: usize,
    points: *const f64,
    point_count: usize,
    setup: *mut *mut carom_setup,
) -> carom_status {
    guarded(|| {
        if !(2..=3).contains(&dimension) {
            return Err(Failure::invalid(format!("dimension is {dimension}; must be 2 or 3")));
        }
        if point_count == 0 {
            return Err(Failure::invalid("there are no points; give the places of all nodes"));
        }
        // SAFETY: the promises of the header.
        unsafe {
            let points = numbers("points", points, product("points", point_count, dimension)?)?;
            give("setup", carom_setup(Handle::new(Setup::new(dimension, points))), setup)
        }
    })
}

/// Frees a setup; contacts that were built of it stay. Null is nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_free(setup: *mut carom_setup) {
    // SAFETY: the promises of the header.
    unsafe { take(setup) }
}

/// Adds the boundary of a body, or the part of it that may touch: the nodes of its facets in VTK's order, shape [facet_count][nodes_per_facet], with 2 or 3 nodes each in
/// the plane and 3, 4, 6, 8 or 9 in space. Facets may be turned either way. Called again with the same name it adds facets, so that there may be several
/// kinds. self_contact says whether the body may touch itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_surface(
    setup: *mut carom_setup,
    name: *const c_char,
    facets: *const i32,
    facet_count: usize,
    nodes_per_facet: usize,
    self_contact: c_int,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let facets = array("facets", facets, product("facets", facet_count, nodes_per_facet)?)?;
            setup.surface(text("name", name)?, facets, nodes_per_facet, self_contact != 0)
        })
    }
}

/// Adds a rigid half space: a point of its plane [m], and a normal towards the free side, of any length.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_plane(
    setup: *mut carom_setup,
    name: *const c_char,
    point: *const f64,
    normal: *const f64,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let point = numbers("point", point, setup.dimension)?;
            let normal = numbers("normal", normal, setup.dimension)?;
            setup.obstacle(text("name", name)?, json!({ "kind": "plane", "point": point, "normal": normal }))
        })
    }
}

/// Adds a rigid ball, in the plane a disc [m]; with cavity not 0 what is around it is rigid, and the inside is free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_sphere(
    setup: *mut carom_setup,
    name: *const c_char,
    centre: *const f64,
    radius: f64,
    cavity: c_int,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let centre = numbers("centre", centre, setup.dimension)?;
            let shape = json!({ "kind": "sphere", "centre": centre, "radius": finite("radius", radius)?, "cavity": cavity != 0 });
            setup.obstacle(text("name", name)?, shape)
        })
    }
}

/// Adds a rigid cylinder without ends, in space: a point and the direction of its axis, and its radius [m]. cavity as of a sphere.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_cylinder(
    setup: *mut carom_setup,
    name: *const c_char,
    point: *const f64,
    axis: *const f64,
    radius: f64,
    cavity: c_int,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let point = numbers("point", point, setup.dimension)?;
            let axis = numbers("axis", axis, setup.dimension)?;
            let radius = finite("radius", radius)?;
            let shape = json!({ "kind": "cylinder", "point": point, "axis": axis, "radius": radius, "cavity": cavity != 0 });
            setup.obstacle(text("name", name)?, shape)
        })
    }
}

/// Adds a rigid box with sides along the axes [m], in the plane a rectangle: its corner with the smallest coordinates, and its sides.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_box(
    setup: *mut carom_setup,
    name: *const c_char,
    corner: *const f64,
    size: *const f64,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let corner = numbers("corner", corner, setup.dimension)?;
            let size = numbers("size", size, setup.dimension)?;
            setup.obstacle(text("name", name)?, json!({ "kind": "box", "corner": corner, "size": size }))
        })
    }
}

/// Adds the inside of a polygon as an obstacle, in the plane: its corners in order [m], shape [point_count][2].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_polygon(
    setup: *mut carom_setup,
    name: *const c_char,
    points: *const f64,
    point_count: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let points = numbers("points", points, product("points", point_count, 2)?)?;
            let points: Vec<&[f64]> = points.chunks_exact(2).collect();
            setup.obstacle(text("name", name)?, json!({ "kind": "polygon", "points": points }))
        })
    }
}

/// Adds what a closed surface of triangles encloses as an obstacle, in space: vertices [m] of shape [vertex_count][3], and the three vertices of every triangle, counter-clockwise as
/// seen from outside, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_triangles(
    setup: *mut carom_setup,
    name: *const c_char,
    vertices: *const f64,
    vertex_count: usize,
    triangles: *const i32,
    triangle_count: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let vertices = numbers("vertices", vertices, product("vertices", vertex_count, 3)?)?;
            let triangles = array("triangles", triangles, product("triangles", triangle_count, 3)?)?;
            if let Some(k) =
                triangles.iter().position(|v| !usize::try_from(*v).is_ok_and(|v| v < vertex_count))
            {
                let message = format!(
                    "triangles: triangle {} has vertex {}, and there are {vertex_count}",
                    k / 3,
                    triangles[k]
                );
                return Err(Failure::invalid(message));
            }
            let vertices: Vec<&[f64]> = vertices.chunks_exact(3).collect();
            let triangles: Vec<&[i32]> = triangles.chunks_exact(3).collect();
            let shape = json!({ "kind": "surface", "vertices": vertices, "triangles": triangles });
            setup.obstacle(text("name", name)?, shape)
        })
    }
}

/// Lets an obstacle move with a constant velocity [m/s].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_velocity(
    setup: *mut carom_setup,
    obstacle: *const c_char,
    velocity: *const f64,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let velocity = numbers("velocity", velocity, setup.dimension)?;
            setup.velocity(text("obstacle", obstacle)?, velocity)
        })
    }
}

/// Sets a number: "friction", Coulomb's coefficient (0); "theta" of the time scheme, the weight of the new velocity in d = dt ((1 - theta) v + theta v_new) (0.5);
/// "tolerance" of the friction solver (1e-12); "max_iterations" (10000).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_number(
    setup: *mut carom_setup,
    key: *const c_char,
    value: f64,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let key = text("key", key)?;
            setup.set(key, json!(finite(key, value)?))
        })
    }
}

/// Sets a word: "condition", where in time contact is ruled, "gap" (the default), "midpoint" or "endpoint"; "targets" are "smooth" (the default) or "faceted"; "discretisation" is
/// "node-to-segment" (the default) or "mortar"; "sources" are "finer", "first", "second" or "both"; "solver" of friction is "auto" (the default) or one of those that the manual lists;
/// "analysis" is "dynamic" (the default) or "static", for load steps without inertia.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_text(
    setup: *mut carom_setup,
    key: *const c_char,
    value: *const c_char,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { carom_setup::change(setup, |setup| setup.set(text("key", key)?, json!(text("value", value)?))) }
}

/// Sets a number of one pair of surfaces or obstacles, which are there already: "friction", or "enabled", 0 or 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_pair_number(
    setup: *mut carom_setup,
    first: *const c_char,
    second: *const c_char,
    key: *const c_char,
    value: f64,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let key = text("key", key)?;
            let value = json!(finite(key, value)?);
            setup.set_pair([text("first", first)?, text("second", second)?], key, value)
        })
    }
}

/// Sets a word of one pair: "sources" or "discretisation".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_pair_text(
    setup: *mut carom_setup,
    first: *const c_char,
    second: *const c_char,
    key: *const c_char,
    value: *const c_char,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            let value = json!(text("value", value)?);
            setup.set_pair([text("first", first)?, text("second", second)?], text("key", key)?, value)
        })
    }
}

/// Numbers your unknowns: that of each point and component, shape [point_count][dimension], from 0 to unknown_count - 1; -1 where motion is prescribed. Nodes may share unknowns.
/// Without this call component i of node n is dimension n + i.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_unknowns(
    setup: *mut carom_setup,
    unknowns: *const i32,
    point_count: usize,
    unknown_count: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| {
            if point_count != setup.point_count() {
                return Err(Failure::not_all(point_count, setup.point_count()));
            }
            let numbers = array("unknowns", unknowns, product("unknowns", point_count, setup.dimension)?)?;
            setup.number(numbers, unknown_count)
        })
    }
}

/// Makes contact as it has been described. Free what is written to contact with carom_contact_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_setup_build(
    setup: *mut carom_setup,
    contact: *mut *mut carom_contact,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_setup::change(setup, |setup| give("contact", carom_contact::new(setup.build()?), contact))
    }
}

/// JSON knows no infinity, and would make nothing of it.
fn finite(name: &str, value: f64) -> Result<Value, Failure> {
    if value.is_finite() {
        Ok(json!(value))
    } else {
        Err(Failure::invalid(format!("{name} = {value}: must be finite")))
    }
}
