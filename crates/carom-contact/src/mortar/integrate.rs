//! The integrals of the multipliers of one source facet against the target facets that it faces.

use std::f64::consts::TAU;

use carom_mesh::Vector;
use smallvec::SmallVec;

use super::clip::{intersection, simplices, size};
use super::plane::{Image, Plane};
use super::quadrature::rule;
use super::row::Row;
use crate::ContactSurface;
use crate::parts::{MAX_FACET_NODES, parts};
use crate::project::Weights;
use crate::tolerances::MORTAR;

/// The integrals of the multipliers of the corners of a part and the weights of the nodes over it.
type Products = [Weights; 4];

/// Nothing yet of this many nodes.
fn products(nodes: usize) -> Products {
    std::array::from_fn(|_| Weights::from_elem(0.0, nodes))
}

/// Adds to the rows of the nodes of the facet `source_facet` what they see of the facets `targets` of the other of two surfaces. `row_of` knows the places
/// of the rows.
///
/// Each part of the source is a plane, in which the facets are cut against it exactly; along its normal the points of both sides
/// face one another. Multipliers are the linear shape functions of the parts, and places those of the surfaces over the facets: between
/// the chords of two round sides with unequal facets there would be a clearance, or an overlap, of the size of their sagittas. On the
/// meridian of a body of revolution a point counts as its circle, 2πr.
pub(super) fn integrate<const D: usize>(
    [of_source, of_target]: [&ContactSurface; 2],
    source_facet: u32,
    targets: impl Iterator<Item = u32> + Clone,
    position: &impl Fn(u32) -> Vector<D>,
    row_of: &impl Fn(u32) -> Option<usize>,
    rows: &mut [Row<D>],
) {
    let dimension = D - 1;
    let source = &of_source.facets[source_facet as usize];
    for (source_part, &(kind, corners)) in parts(source.kind).iter().enumerate() {
        let source_nodes = of_source.nodes_over(source_facet, source_part);
        let places: SmallVec<[Vector<D>; 4]> = corners.iter().map(|&a| position(source.nodes[a])).collect();
        let Some(plane) = Plane::through(&places) else { continue };
        let in_plane = |&n: &u32| plane.coordinates(&position(n));
        let own = Image::new(source.kind, source.nodes.iter().map(in_plane));
        let part = Image::new(kind, places.iter().map(|x| plane.coordinates(x)));
        let outline = own.polygon(corners);
        let whole: f64 = simplices(dimension, &outline).map(|s| size(dimension, &s)).sum();
        let mut covered = [0.0; 4];
        let mut with_source = products(source_nodes.len());
        let row: SmallVec<[Option<usize>; 4]> = corners.iter().map(|&a| row_of(source.nodes[a])).collect();
        for target_facet in targets.clone() {
            let target = &of_target.facets[target_facet as usize];
            let other = Image::new(target.kind, target.nodes.iter().map(in_plane));
            let points = rule(dimension, source.kind != kind || parts(target.kind).len() > 1);
            for (target_part, &(target_kind, target_corners)) in parts(target.kind).iter().enumerate() {
                let target_nodes = of_target.nodes_over(target_facet, target_part);
                let its_corners = target_corners.iter().map(|&c| other.node(c));
                let other_part = Image::new(target_kind, its_corners);
                let mut with_target = products(target_nodes.len());
                let mut overlap = 0.0;
                let common = intersection(dimension, &outline, &other.polygon(target_corners));
                for simplex in simplices(dimension, &common) {
                    let simplex_size = size(dimension, &simplex);
                    if simplex_size <= MORTAR.negligible * whole {
                        continue;
                    }
                    overlap += simplex_size;
                    let mut values = [[0.0; MAX_FACET_NODES]; 4];
                    for (barycentric, share) in points {
                        let point = std::array::from_fn(|i| {
                            barycentric.iter().zip(&simplex).map(|(l, corner)| l * corner[i]).sum()
                        });
                        let [multiplier, source_shape, target_shape, over_target] = &mut values;
                        own.shape_at(&point, source_shape);
                        if kind == source.kind {
                            *multiplier = *source_shape;
                        } else {
                            part.shape_at(&point, multiplier);
                        }
                        other.shape_at(&point, target_shape);
                        if target_kind == target.kind {
                            *over_target = *target_shape;
                        } else {
                            other_part.shape_at(&point, over_target);
                        }
                        let mut measure = share * simplex_size;
                        if of_source.is_meridian {
                            let nodes = source.nodes.iter().zip(&*source_shape);
                            let radius: f64 = nodes.map(|(&n, shape)| shape * position(n)[0]).sum();
                            measure *= TAU * radius;
                        }
                        let source_weights =
                            of_source.weights_over(source_facet, source_part, source_shape, multiplier);
                        let target_weights =
                            of_target.weights_over(target_facet, target_part, target_shape, over_target);
                        for v in 0..corners.len() {
                            let weight = measure * multiplier[v];
                            covered[v] += weight;
                            for a in 0..source_nodes.len() {
                                with_source[v][a] += weight * source_weights[a];
                            }
                            for c in 0..target_nodes.len() {
                                with_target[v][c] += weight * target_weights[c];
                            }
                        }
                    }
                }
                if overlap > 0.0 {
                    for (row, products) in row.iter().zip(&with_target) {
                        let Some(k) = *row else { continue };
                        target_nodes.iter().zip(products).for_each(|(&n, &m)| rows[k].add_target(n, m));
                    }
                }
            }
        }
        for (v, row) in row.iter().enumerate() {
            let Some(k) = *row else { continue };
            let circle = if of_source.is_meridian { TAU * places[v][0].abs() } else { 1.0 };
            rows[k].add_whole(whole * circle / corners.len() as f64);
            if covered[v] > 0.0 {
                rows[k].add_covered(covered[v], &plane.normal());
                source_nodes.iter().zip(&with_source[v]).for_each(|(&n, &d)| rows[k].add_source(n, d));
            }
        }
    }
}
