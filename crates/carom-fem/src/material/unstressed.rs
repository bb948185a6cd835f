use super::{Mat3, Material, Tangent};

/// No law at all: no energy and no stress. It is that of bodies whose cells never deform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unstressed;

impl Material for Unstressed {
    fn energy(&self, _f: &Mat3) -> f64 {
        0.0
    }

    fn stress(&self, _f: &Mat3) -> Mat3 {
        Mat3::zeros()
    }

    fn stress_and_tangent(&self, _f: &Mat3) -> (Mat3, Tangent<3>) {
        (Mat3::zeros(), [[[[0.0; 3]; 3]; 3]; 3])
    }
}
