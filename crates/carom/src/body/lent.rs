//! What stands in the place of a body while another thread iterates it.

use carom_mesh::{Matrix, Vector};

use super::{Balance, Body, BodyEnd, BodyState, Forecast, Guess, Interval, Jolt, Outlook};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};

/// A body that is elsewhere. Nobody asks it for anything: who iterates has lists of the bodies that it has.
#[derive(Debug)]
pub(crate) struct Lent;

fn elsewhere() -> ! {
    unreachable!("a body is asked for where it is")
}

impl<const D: usize> Body<D> for Lent {
    fn measure(&self, _: &BodyState<'_, D>, _: &mut [Vector<D>]) -> Energies {
        elsewhere()
    }

    fn mean_velocity(&self, _: &[Vector<D>]) -> Vector<D> {
        elsewhere()
    }

    fn begin_step(
        &mut self,
        _: &Interval,
        _: &BodyState<'_, D>,
        _: &mut [Vector<D>],
    ) -> Result<Forecast, StepError> {
        elsewhere()
    }

    fn residual(&mut self, _: &Guess<'_, D>, _: Option<f64>, _: &mut [Vector<D>]) {
        elsewhere()
    }

    fn begin_solve(&mut self, _: &[Vector<D>]) {
        elsewhere()
    }

    fn set_reach(&mut self, _: &[u32]) {
        elsewhere()
    }

    fn partial_solve(&mut self, _: &[u32], _: &mut [Vector<D>]) {
        elsewhere()
    }

    fn add_forces(&mut self, _: &[u32], _: &[Vector<D>]) {
        elsewhere()
    }

    fn end_solve(&mut self, _: &mut [Vector<D>]) {
        elsewhere()
    }

    fn balance(&mut self, _: &Guess<'_, D>, _: Outlook) -> Balance {
        elsewhere()
    }

    fn velocity_half_way(&self, _: u32, _: &Vector<D>) -> Vector<D> {
        elsewhere()
    }

    fn round_off(&self) -> f64 {
        elsewhere()
    }

    fn tangent_worth(&self) -> i32 {
        elsewhere()
    }

    fn turn(&self) -> Matrix<D> {
        elsewhere()
    }

    fn near(&mut self, _: u32) -> Option<Vec<u32>> {
        elsewhere()
    }

    fn renew(&mut self, _: &Guess<'_, D>, _: bool) -> Result<(), StepError> {
        elsewhere()
    }

    fn forget(&mut self) {
        elsewhere()
    }

    fn end_step(&mut self, _: &Guess<'_, D>, _: Option<f64>, _: BodyEnd<'_, D>) -> (BodyLedger, Energies) {
        elsewhere()
    }

    fn mass_of(&self, _: u32) -> f64 {
        elsewhere()
    }

    fn jolt(
        &mut self,
        _: &mut [Vector<D>],
        _: &BodyState<'_, D>,
        _: &mut [Vector<D>],
        _: &mut [Vector<D>],
    ) -> Jolt {
        elsewhere()
    }

    fn generation(&self) -> u64 {
        elsewhere()
    }

    fn respond(&mut self, _: &[u32]) {
        elsewhere()
    }

    fn response(&self, _: u32, _: u32, _: usize) -> Matrix<D> {
        elsewhere()
    }
}
