use std::collections::BTreeMap;

use carom_mesh::{CellKind, Facet, Matrix, Vector, tensor};

use crate::Body;
use crate::quadrature::{Integrand, rule};

/// Facets of a body over which loads are integrated.
#[derive(Debug, Clone)]
pub struct FacetPatch {
    facets: Vec<Facet>,
    rules: BTreeMap<CellKind, Vec<FacetPoint>>,
}

/// A quadrature point of a reference facet.
#[derive(Debug, Clone)]
struct FacetPoint {
    weight: f64,
    shape: Vec<f64>,
    gradient: Vec<[f64; 3]>,
}

impl FacetPatch {
    /// The patch of these facets of `body`.
    #[must_use]
    pub fn new<const D: usize>(body: &Body<D>, facets: Vec<Facet>) -> Self {
        let mut rules = BTreeMap::new();
        for facet in &facets {
            rules.entry(facet.kind).or_insert_with(|| points(facet.kind, body.is_axisymmetric()));
        }
        Self { facets, rules }
    }

    /// Calls `add(node, N_a n dA)` with the share [m²] of every node in the outward area of the patch. The nodes of `body` are
    /// displaced by `u` [m]. The share is Σ over quadrature points of N_a times the area vector. A 2D body has a depth.
    pub fn area_vectors<const D: usize>(
        &self,
        body: &Body<D>,
        u: &[Vector<D>],
        mut add: impl FnMut(u32, Vector<D>),
    ) {
        for facet in &self.facets {
            for point in &self.rules[&facet.kind] {
                let at = |n: u32| body.mesh().nodes()[n as usize] + u[n as usize];
                let area = point.area_vector(facet, body, at);
                for (&node, shape) in facet.nodes.iter().zip(&point.shape) {
                    add(node, area * *shape);
                }
            }
        }
    }

    /// Calls `add(a, b, ∂(∫ N_a n dA)/∂u_b)` [m] with how the shares of [`Self::area_vectors`] change with the displacements.
    ///
    /// By central differences of any width: as functions of one coordinate they are polynomials of the second degree at most, and these are exact.
    pub fn area_gradients<const D: usize>(
        &self,
        body: &Body<D>,
        u: &[Vector<D>],
        mut add: impl FnMut(u32, u32, Matrix<D>),
    ) {
        let place = |n: u32| body.mesh().nodes()[n as usize] + u[n as usize];
        for facet in &self.facets {
            let width = (place(facet.nodes[1]) - place(facet.nodes[0])).norm();
            for &moved in &facet.nodes {
                for point in &self.rules[&facet.kind] {
                    let mut gradient = Matrix::<D>::zeros();
                    for component in 0..D {
                        let [ahead, back] = [width, -width].map(|step| {
                            let at = |n: u32| {
                                let mut x = place(n);
                                x[component] += if n == moved { step } else { 0.0 };
                                x
                            };
                            point.area_vector(facet, body, at)
                        });
                        gradient.set_column(component, &((ahead - back) / (2.0 * width)));
                    }
                    for (&node, shape) in facet.nodes.iter().zip(&point.shape) {
                        add(node, moved, gradient * *shape);
                    }
                }
            }
        }
    }

    /// The share [m²] of every node in the reference area of the patch, ∫ N_a dA, by node.
    #[must_use]
    pub fn areas<const D: usize>(&self, body: &Body<D>) -> BTreeMap<u32, f64> {
        let mut areas = BTreeMap::new();
        for facet in &self.facets {
            for point in &self.rules[&facet.kind] {
                let area = point.area_vector(facet, body, |n| body.mesh().nodes()[n as usize]).norm();
                for (&node, shape) in facet.nodes.iter().zip(&point.shape) {
                    *areas.entry(node).or_insert(0.0) += area * shape;
                }
            }
        }
        areas
    }
}

fn points(kind: CellKind, of_revolution: bool) -> Vec<FacetPoint> {
    let reference = kind.reference();
    rule(kind, Integrand::Values, of_revolution)
        .into_iter()
        .map(|q| {
            let mut shape = vec![0.0; kind.node_count()];
            let mut gradient = vec![[0.0; 3]; kind.node_count()];
            (reference.shape)(&q.xi, &mut shape);
            (reference.gradient)(&q.xi, &mut gradient);
            FacetPoint { weight: q.weight, shape, gradient }
        })
        .collect()
}

impl FacetPoint {
    /// Outward normal times the area that belongs to the point [m²].
    fn area_vector<const D: usize>(
        &self,
        facet: &Facet,
        body: &Body<D>,
        at: impl Fn(u32) -> Vector<D>,
    ) -> Vector<D> {
        let mut tangents = [Vector::<D>::zeros(); 2];
        let mut x = Vector::<D>::zeros();
        for ((&node, shape), gradient) in facet.nodes.iter().zip(&self.shape).zip(&self.gradient) {
            let node = at(node);
            x += node * *shape;
            tangents.iter_mut().zip(gradient).for_each(|(t, g)| *t += node * *g);
        }
        let mut normal = Vector::<D>::zeros();
        if D == 2 {
            (normal[0], normal[1]) = (tangents[0][1], -tangents[0][0]);
        } else {
            let product = tensor::cross(&tangents[0], &tangents[1]);
            (0..D).for_each(|i| normal[i] = product[i]);
        }
        normal * (self.weight * body.depth(&x))
    }
}
