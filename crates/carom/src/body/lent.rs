//! What stands in the place of a body that another workspace has.

use carom_mesh::{Matrix, Vector};

use super::{Body, BodyEnd, BodyState, Forecast, Guess, Interval, Jolt};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};

/// A body that is elsewhere. Nobody asks it for anything: who iterates has lists of the bodies that it has.
#[derive(Debug)]
pub(crate) struct Lent;

impl<const D: usize> Body<D> for Lent {
    fn measure(&self, _: &BodyState<'_, D>, _: &mut [Vector<D>]) -> Energies {
        unreachable!()
    }

    fn mean_velocity(&self, _: &[Vector<D>]) -> Vector<D> {
        unreachable!()
    }

    fn begin_step(
        &mut self,
        _: &Interval,
        _: &BodyState<'_, D>,
        _: &mut [Vector<D>],
    ) -> Result<Forecast, StepError> {
        unreachable!()
    }

    fn residual(&mut self, _: &Guess<'_, D>, _: Option<f64>, _: &mut [Vector<D>]) {
        unreachable!()
    }

    fn begin_solve(&mut self, _: &[Vector<D>]) {
        unreachable!()
    }

    fn set_reach(&mut self, _: &[u32]) {
        unreachable!()
    }

    fn partial_solve(&mut self, _: &[u32], _: &mut [Vector<D>]) {
        unreachable!()
    }

    fn add_forces(&mut self, _: &[u32], _: &[Vector<D>]) {
        unreachable!()
    }

    fn end_solve(&mut self, _: &mut [Vector<D>]) {
        unreachable!()
    }

    fn renew(&mut self, _: &Guess<'_, D>, _: bool) -> Result<(), StepError> {
        unreachable!()
    }

    fn forget(&mut self) {
        unreachable!()
    }

    fn end_step(&mut self, _: &Guess<'_, D>, _: Option<f64>, _: BodyEnd<'_, D>) -> (BodyLedger, Energies) {
        unreachable!()
    }

    fn mass_of(&self, _: u32) -> f64 {
        unreachable!()
    }

    fn jolt(
        &mut self,
        _: &mut [Vector<D>],
        _: &BodyState<'_, D>,
        _: &mut [Vector<D>],
        _: &mut [Vector<D>],
    ) -> Jolt {
        unreachable!()
    }

    fn generation(&self) -> u64 {
        unreachable!()
    }

    fn respond(&mut self, _: &[u32]) {
        unreachable!()
    }

    fn response(&self, _: u32, _: u32, _: usize) -> Matrix<D> {
        unreachable!()
    }
}
