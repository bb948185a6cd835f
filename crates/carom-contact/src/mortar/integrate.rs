//! The integrals of the multipliers of one source facet against the target facets that it faces.

use std::f64::consts::TAU;

use carom_mesh::Vector;
use smallvec::SmallVec;

use super::clip::{cut, simplices, size};
use super::plane::{Image, Plane};
use super::quadrature::rule;
use super::row::Row;
use super::share::common_part;
use crate::ContactSurface;
use crate::parts::{MAX_FACET_NODES, parts};
use crate::path::Positions;
use crate::project::{Reach, Weights};
use crate::surface::diameter;
use crate::tolerances::MORTAR;

/// The integrals of the multipliers of the corners of a part and the weights of the nodes over it.
type Products = [Weights; 4];

/// Nothing yet of this many nodes.
fn products(nodes: usize) -> Products {
    std::array::from_fn(|_| Weights::from_elem(0.0, nodes))
}

/// Adds to the rows of the nodes of the facet `source_facet` what they see of the facets `targets` of the other of two surfaces. `row_of` knows the places
/// of the rows of its nodes, counted in the facet.
///
/// Each part of the source is a plane, in which the facets are cut against it exactly; along its normal the points of both sides
/// face one another. Multipliers are the linear shape functions of the parts, and places those of the surfaces over the facets: between
/// the chords of two round sides with unequal facets there would be a clearance, or an overlap, of the size of their sagittas. What faces a point
/// of the source is then the closest point of the target. Where two smooth sides were only compared at one place of their planes, these
/// points were beside one another, and the pair of forces had a moment. On the
/// meridian of a body of revolution a point counts as its circle, 2πr.
pub(super) fn integrate<const D: usize>(
    [of_source, of_target]: [&ContactSurface; 2],
    source_facet: u32,
    targets: impl Iterator<Item = u32> + Clone,
    position: &Positions<'_, D>,
    row_of: &impl Fn(usize) -> Option<usize>,
    rows: &mut [Row<D>],
) {
    let dimension = D - 1;
    let source = &of_source.facets[source_facet as usize];
    let source_size = diameter(source, position);
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
        let row: SmallVec<[Option<usize>; 4]> = corners.iter().map(|&a| row_of(a)).collect();
        for target_facet in targets.clone() {
            let target = &of_target.facets[target_facet as usize];
            let sizes = [source_size, diameter(target, position)];
            let other = Image::new(target.kind, target.nodes.iter().map(in_plane));
            let points = rule(dimension, source.kind != kind || parts(target.kind).len() > 1);
            let is_smooth = of_target.is_smooth_over(target_facet);
            let mut with_target = products(target.nodes.len());
            let mut overlap = 0.0;
            for &(_, target_corners) in parts(target.kind) {
                let opposite: SmallVec<[Vector<D>; 4]> =
                    target_corners.iter().map(|&a| position(target.nodes[a])).collect();
                let Some(opposite) = Plane::through(&opposite) else { continue };
                let outlines = [&outline, &other.polygon(target_corners)];
                let Some((common, share)) = common_part([&plane, &opposite], outlines, sizes) else {
                    continue;
                };
                for simplex in cut(dimension, &common) {
                    let simplex_size = size(dimension, &simplex);
                    if simplex_size <= MORTAR.negligible * whole {
                        continue;
                    }
                    overlap += simplex_size;
                    let mut values = [[0.0; MAX_FACET_NODES]; 3];
                    for (barycentric, of_rule) in points {
                        let point = std::array::from_fn(|i| {
                            barycentric.iter().zip(&simplex).map(|(l, corner)| l * corner[i]).sum()
                        });
                        let [multiplier, source_shape, target_shape] = &mut values;
                        own.shape_at(&point, source_shape);
                        if kind == source.kind {
                            *multiplier = *source_shape;
                        } else {
                            part.shape_at(&point, multiplier);
                        }
                        other.shape_at(&point, target_shape);
                        let mut measure = share * of_rule * simplex_size;
                        if of_source.is_meridian {
                            let nodes = source.nodes.iter().zip(&*source_shape);
                            let radius: f64 = nodes.map(|(&n, shape)| shape * position(n)[0]).sum();
                            measure *= TAU * radius;
                        }
                        let source_weights =
                            of_source.weights_over(source_facet, source_part, source_shape, multiplier);
                        let weights: SmallVec<[f64; 4]> =
                            multiplier[..corners.len()].iter().map(|m| measure * m).collect();
                        for (v, weight) in weights.iter().enumerate() {
                            covered[v] += weight;
                            for (sum, source_weight) in with_source[v].iter_mut().zip(&source_weights) {
                                *sum += weight * source_weight;
                            }
                        }
                        if is_smooth {
                            let nodes = source_nodes.iter().zip(&source_weights);
                            let x = nodes.fold(Vector::zeros(), |x, (&n, &w)| x + position(n) * w);
                            let foot = of_target.project(target_facet, &x, Reach::Beyond, position);
                            for (row, weight) in row.iter().zip(&weights) {
                                let Some(k) = *row else { continue };
                                let shares = foot.nodes.iter().zip(&foot.weights);
                                shares.for_each(|(&n, &w)| rows[k].add_target(n, weight * w));
                            }
                            continue;
                        }
                        for (products, weight) in with_target.iter_mut().zip(&weights) {
                            for (sum, shape) in products.iter_mut().zip(&*target_shape) {
                                *sum += weight * shape;
                            }
                        }
                    }
                }
            }
            if overlap > 0.0 && !is_smooth {
                for (row, products) in row.iter().zip(&with_target) {
                    let Some(k) = *row else { continue };
                    target.nodes.iter().zip(products).for_each(|(&n, &m)| rows[k].add_target(n, m));
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
