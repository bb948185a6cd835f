//! Contact in the caller's time loop: the order of calls, the caller's unknowns, the books.

use std::collections::BTreeMap;
use std::ffi::CString;

use carom::{PairLedger, PlantedStep};
use carom_friction::SolveReport;

use crate::compliance::{Columns, Compliance, condensed, refuse_rigid};
use crate::status::Failure;
use crate::steps::Steps;

/// The caller's numbers of the unknown of each point and component.
#[derive(Debug, Clone)]
pub struct Unknowns {
    numbers: Vec<Option<usize>>,
    count: usize,
}

impl Unknowns {
    /// Component i of point n is D n + i.
    pub fn in_order(count: usize) -> Self {
        Self { numbers: (0..count).map(Some).collect(), count }
    }

    /// As the caller numbers them; less than 0 is prescribed.
    pub fn of(numbers: &[i32], count: usize) -> Result<Self, Failure> {
        let numbers: Vec<Option<usize>> = numbers.iter().map(|&n| usize::try_from(n).ok()).collect();
        match numbers.iter().flatten().find(|n| **n >= count) {
            Some(n) => Err(Failure::invalid(format!(
                "unknowns has {n}, and there are {count}; they are numbered from 0"
            ))),
            None => Ok(Self { numbers, count }),
        }
    }

    /// Which components of the points are prescribed.
    pub fn held<const D: usize>(&self) -> Vec<[bool; D]> {
        let point = |numbers: &[Option<usize>]| std::array::from_fn(|i| numbers[i].is_none());
        self.numbers.chunks_exact(D).map(point).collect()
    }
}

/// What has been done in the present step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Stage {
    Idle,
    Searched,
    Evaluated,
    Solved,
}

/// Contact, and what is known of the present step.
pub struct Contact {
    steps: Box<dyn Steps>,
    points: usize,
    dimension: usize,
    unknowns: Unknowns,
    /// Whether what is ruled, or where obstacles go, depends on velocities.
    needs_velocity: bool,
    stage: Stage,
    /// H, and W as it was last solved with.
    columns: Columns,
    force: Vec<f64>,
    report: Option<SolveReport>,
    pub books: Books,
}

/// What contact did since the start [J].
#[derive(Debug, Clone, Default)]
pub struct Books {
    /// By the numbers of pairs that have touched.
    pub pairs: BTreeMap<usize, PairLedger>,
    /// The two names of pairs that were asked for, ended for C.
    names: BTreeMap<usize, [CString; 2]>,
    pub certificate: f64,
    pub min_gap: f64,
    pub steps: usize,
}

impl Contact {
    pub fn new(
        steps: Box<dyn Steps>,
        [points, dimension]: [usize; 2],
        unknowns: Unknowns,
        needs_velocity: bool,
    ) -> Self {
        let books = Books { min_gap: f64::INFINITY, ..Books::default() };
        Self {
            steps,
            points,
            dimension,
            unknowns,
            needs_velocity,
            stage: Stage::Idle,
            columns: Columns::default(),
            force: Vec::new(),
            report: None,
            books,
        }
    }

    /// How many numbers say where the points are, if there are as many as the caller says.
    pub fn size_of(&self, point_count: usize) -> Result<usize, Failure> {
        if point_count != self.points {
            return Err(Failure::not_all(point_count, self.points));
        }
        Ok(self.points * self.dimension)
    }

    fn refuse_before(&self, stage: Stage, message: &str) -> Result<(), Failure> {
        if self.stage < stage { Err(Failure::invalid(message)) } else { Ok(()) }
    }

    pub fn search(
        &mut self,
        points: &[f64],
        velocity: Option<&[f64]>,
        time_step: f64,
        reach: f64,
    ) -> Result<(), Failure> {
        if !(time_step.is_finite() && time_step > 0.0) {
            return Err(Failure::invalid(format!("time_step = {time_step}: must be greater than 0")));
        }
        if !(reach.is_finite() && reach >= 0.0) {
            return Err(Failure::invalid(format!(
                "reach = {reach}: must be greater than 0, or 0 for as far as anything moves"
            )));
        }
        if velocity.is_none() && (reach == 0.0 || self.needs_velocity) {
            let why = if self.needs_velocity {
                "what the condition rules and where obstacles go depends on it"
            } else {
                "so that it is known how far to look, or give a reach"
            };
            return Err(Failure::invalid(format!("velocity is a null pointer; give it, {why}")));
        }
        self.stage = Stage::Idle;
        let still = vec![0.0; points.len()];
        let reach = (reach > 0.0).then_some(reach);
        self.steps.search(points, velocity.unwrap_or(&still), time_step, reach)?;
        self.stage = Stage::Searched;
        Ok(())
    }

    pub fn evaluate(&mut self, points: &[f64]) -> Result<(), Failure> {
        self.refuse_before(Stage::Searched, "nothing was searched in this step: search first")?;
        self.steps.evaluate(points);
        let dimension = self.dimension;
        let frames = self.steps.frames();
        let mut columns = vec![Vec::new(); self.steps.count() * dimension];
        self.steps.each_weight(&mut |contact, node, weight| {
            let unknowns = &self.unknowns.numbers[node as usize * dimension..][..dimension];
            for row in 0..dimension {
                let axis = &frames[(contact * dimension + row) * dimension..][..dimension];
                let entries = unknowns.iter().zip(axis);
                columns[contact * dimension + row]
                    .extend(entries.filter_map(|(u, n)| u.map(|u| (u, weight * n))));
            }
        });
        self.columns.set(columns);
        self.force = vec![0.0; self.unknowns.count];
        self.report = None;
        self.stage = if self.steps.count() == 0 { Stage::Solved } else { Stage::Evaluated };
        Ok(())
    }

    /// What takes part, once it is evaluated.
    pub fn evaluated(&self) -> Result<&dyn Steps, Failure> {
        self.refuse_before(
            Stage::Evaluated,
            "nothing was evaluated in this step: search and evaluate first",
        )?;
        Ok(self.steps.as_ref())
    }

    /// H of what takes part.
    pub fn map(&self) -> Result<&Columns, Failure> {
        self.evaluated().map(|_| &self.columns)
    }

    /// How many take part, evaluated or not.
    pub fn count(&self) -> Result<usize, Failure> {
        self.refuse_before(Stage::Searched, "nothing was searched in this step: search first")?;
        Ok(self.steps.count())
    }

    /// How many unknowns there are, if the caller knows it too.
    pub fn refuse_unknowns(&self, count: usize) -> Result<(), Failure> {
        if count != self.unknowns.count {
            let message =
                format!("unknown_count is {count}; the unknowns were numbered up to {}", self.unknowns.count);
            return Err(Failure::invalid(message));
        }
        Ok(())
    }

    /// Solves for the reactions; the motion with them [m].
    pub fn solve(&mut self, free: &[f64], compliance: &Compliance) -> Result<Vec<f64>, Failure> {
        self.evaluated()?;
        let size = self.columns.count();
        if size == 0 {
            return Ok(free.to_vec());
        }
        self.stage = Stage::Evaluated;
        let w = condensed(&self.columns, compliance)?;
        refuse_rigid(&w, size, self.dimension)?;
        self.report = Some(self.steps.solve(&w, &self.columns.transposed_times(free))?);
        self.force = self.columns.times(&self.steps.reactions(), self.unknowns.count);
        let response = compliance.apply(&self.force)?;
        self.stage = Stage::Solved;
        Ok(free.iter().zip(response).map(|(free, more)| free + more).collect())
    }

    /// H r [N] as last solved for.
    pub fn force(&self) -> Result<&[f64], Failure> {
        self.refuse_before(Stage::Solved, "the contacts have no reactions: solve first, or set them")?;
        Ok(&self.force)
    }

    /// What the solver said; nothing without contacts.
    pub fn report(&self) -> Result<Option<&SolveReport>, Failure> {
        self.force().map(|_| self.report.as_ref())
    }

    pub fn set_reactions(&mut self, reactions: &[f64]) -> Result<(), Failure> {
        self.evaluated()?;
        self.steps.set_reactions(reactions);
        self.force = self.columns.times(reactions, self.unknowns.count);
        self.stage = Stage::Solved;
        Ok(())
    }

    pub fn missed(&mut self, points: &[f64]) -> Result<bool, Failure> {
        self.evaluated()?;
        let has_missed = self.steps.missed(points)?;
        if has_missed {
            self.stage = Stage::Searched;
        }
        Ok(has_missed)
    }

    pub fn accept(&mut self, points: &[f64]) -> Result<PlantedStep, Failure> {
        self.force()?;
        let (step, done) = self.steps.accept(points);
        self.stage = Stage::Idle;
        let books = &mut self.books;
        done.into_iter().for_each(|(number, work)| *books.pairs.entry(number).or_default() += work);
        books.certificate = books.certificate.max(step.certificate);
        books.min_gap = books.min_gap.min(step.min_gap);
        books.steps += 1;
        Ok(step)
    }

    /// The two names of a pair. Where they are does not change as long as this lives.
    pub fn pair_names(&mut self, number: usize) -> Result<&[CString; 2], Failure> {
        let names = self.steps.pair_names(number);
        let names = names.ok_or_else(|| {
            Failure::invalid(format!(
                "there is no pair of the number {number}; carom_contact_pairs tells those of contacts"
            ))
        })?;
        let ended = |name: String| CString::new(name).unwrap_or_default();
        Ok(self.books.names.entry(number).or_insert_with(|| names.map(ended)))
    }

    /// What the two of these names did to one another.
    pub fn pair_work(&self, names: [&str; 2]) -> Result<PairLedger, Failure> {
        let number = self.steps.pair_of(&names.map(String::from)).ok_or_else(|| {
            Failure::invalid(format!(
                "{:?} and {:?} are no surfaces or obstacles that may touch",
                names[0], names[1]
            ))
        })?;
        Ok(self.books.pairs.get(&number).copied().unwrap_or_default())
    }

    /// Time since the first step [s].
    pub fn time(&self) -> f64 {
        self.steps.time()
    }
}
