//! What stands in the place of a body that another workspace has.

use carom_mesh::{Matrix, Vector};

use super::{Body, BodyEnd, BodyState, Forecast, Guess, Interval, Jolt};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};

/// A body that is elsewhere: nobody asks it for anything.
#[derive(Debug)]
pub(crate) struct Lent;

/// Why nothing of it is asked for.
const ELSEWHERE: &str = "a body is asked for where it is";

impl<const D: usize> Body<D> for Lent {
    fn measure(&self, _: &BodyState<'_, D>, _: &mut [Vector<D>]) -> Energies {
        unreachable!("{ELSEWHERE}")
    }

    fn mean_velocity(&self, _: &[Vector<D>]) -> Vector<D> {
        unreachable!("{ELSEWHERE}")
    }

    fn begin_step(
        &mut self,
        _: &Interval,
        _: &BodyState<'_, D>,
        _: &mut [Vector<D>],
    ) -> Result<Forecast, StepError> {
        unreachable!("{ELSEWHERE}")
    }

    fn residual(&mut self, _: &Guess<'_, D>, _: Option<f64>, _: &mut [Vector<D>]) {
        unreachable!("{ELSEWHERE}")
    }

    fn begin_solve(&mut self, _: &[Vector<D>]) {
        unreachable!("{ELSEWHERE}")
    }

    fn set_reach(&mut self, _: &[u32]) {
        unreachable!("{ELSEWHERE}")
    }

    fn partial_solve(&mut self, _: &[u32], _: &mut [Vector<D>]) {
        unreachable!("{ELSEWHERE}")
    }

    fn add_forces(&mut self, _: &[u32], _: &[Vector<D>]) {
        unreachable!("{ELSEWHERE}")
    }

    fn end_solve(&mut self, _: &mut [Vector<D>]) {
        unreachable!("{ELSEWHERE}")
    }

    fn renew(&mut self, _: &Guess<'_, D>, _: bool) -> Result<(), StepError> {
        unreachable!("{ELSEWHERE}")
    }

    fn forget(&mut self) {
        unreachable!("{ELSEWHERE}")
    }

    fn end_step(&mut self, _: &Guess<'_, D>, _: Option<f64>, _: BodyEnd<'_, D>) -> (BodyLedger, Energies) {
        unreachable!("{ELSEWHERE}")
    }

    fn mass_of(&self, _: u32) -> f64 {
        unreachable!("{ELSEWHERE}")
    }

    fn jolt(
        &mut self,
        _: &mut [Vector<D>],
        _: &BodyState<'_, D>,
        _: &mut [Vector<D>],
        _: &mut [Vector<D>],
    ) -> Jolt {
        unreachable!("{ELSEWHERE}")
    }

    fn generation(&self) -> u64 {
        unreachable!("{ELSEWHERE}")
    }

    fn respond(&mut self, _: &[u32]) {
        unreachable!("{ELSEWHERE}")
    }

    fn response(&self, _: u32, _: u32, _: usize) -> Matrix<D> {
        unreachable!("{ELSEWHERE}")
    }
}
