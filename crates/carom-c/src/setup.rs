//! What there is and what may touch what, piece by piece, by the names of the case file.

use carom::{Outline, PlantedContact, PlantedSpec, Surfaces};
use serde_json::{Value, json};

use crate::contact::{Contact, Unknowns};
use crate::status::Failure;
use crate::steps::{Steps, vectors};

/// Contact as the caller describes it.
pub struct Setup {
    pub dimension: usize,
    points: Vec<f64>,
    outlines: Vec<Outline>,
    obstacles: Vec<Value>,
    contact: Value,
    theta: Option<f64>,
    unknowns: Unknowns,
}

impl Setup {
    /// Points without deformation [m], and all else as it is where nothing is said.
    pub fn new(dimension: usize, points: &[f64]) -> Self {
        let contact = json!({
            "condition": "gap",
            "friction": 0.0,
            "solver": { "kind": "auto", "tolerance": 1e-12, "max_iterations": 10_000 },
            "sources": null,
            "targets": "smooth",
            "discretisation": "node-to-segment",
            "certificate_tolerance": 1e-9,
            "penetration_tolerance": 0.01,
            "pairs": [],
        });
        let unknowns = Unknowns::in_order(points.len());
        Self {
            dimension,
            points: points.to_vec(),
            outlines: Vec::new(),
            obstacles: Vec::new(),
            contact,
            theta: Some(0.5),
            unknowns,
        }
    }

    /// How many points there are.
    pub fn point_count(&self) -> usize {
        self.points.len() / self.dimension
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        let obstacles = self.obstacles.iter().filter_map(|o| o["name"].as_str());
        self.outlines.iter().map(|o| o.name.as_str()).chain(obstacles)
    }

    fn refuse_taken(&self, name: &str) -> Result<(), Failure> {
        if self.names().any(|other| other == name) {
            return Err(Failure::invalid(format!("{name:?} is the name of two surfaces or obstacles")));
        }
        Ok(())
    }

    /// Adds facets to the surface of this name, of `width` nodes each.
    pub fn surface(
        &mut self,
        name: &str,
        facets: &[i32],
        width: usize,
        touches_itself: bool,
    ) -> Result<(), Failure> {
        let mut own = Vec::new();
        for (k, facet) in facets.chunks_exact(width.max(1)).enumerate() {
            let number = |&node: &i32| {
                u32::try_from(node).map_err(|_| {
                    let key = format!("surfaces.{name}.facets");
                    let message = format!("{key}: facet {k} has node {node}; nodes are numbered from 0");
                    Failure::invalid(message)
                })
            };
            own.push(facet.iter().map(number).collect::<Result<Vec<_>, _>>()?);
        }
        if own.is_empty() {
            return Err(Failure::invalid(format!(
                "surfaces.{name}.facets: there are none; give one at least"
            )));
        }
        if let Some(outline) = self.outlines.iter_mut().find(|o| o.name == name) {
            outline.facets.append(&mut own);
            outline.touches_itself |= touches_itself;
            return Ok(());
        }
        self.refuse_taken(name)?;
        self.outlines.push(Outline { name: name.to_string(), facets: own, touches_itself });
        Ok(())
    }

    /// Adds an obstacle: its shape by the keys of the case file.
    pub fn obstacle(&mut self, name: &str, mut shape: Value) -> Result<(), Failure> {
        self.refuse_taken(name)?;
        shape["name"] = json!(name);
        self.obstacles.push(shape);
        Ok(())
    }

    /// Lets an obstacle move on and on.
    pub fn velocity(&mut self, name: &str, velocity: &[f64]) -> Result<(), Failure> {
        let found = self.obstacles.iter_mut().find(|o| o["name"] == name);
        let obstacle = found
            .ok_or_else(|| Failure::invalid(format!("there is no obstacle named {name:?}; add it first")))?;
        obstacle["velocity"] = json!(velocity);
        Ok(())
    }

    /// Sets a value of contact as a whole.
    pub fn set(&mut self, key: &str, value: Value) -> Result<(), Failure> {
        let mut contact = self.contact.clone();
        match key {
            "analysis" => return self.set_analysis(&value),
            "theta" => {
                self.theta = value.as_f64();
                return Ok(());
            }
            "solver" => contact["solver"]["kind"] = value,
            "tolerance" => contact["solver"]["tolerance"] = value,
            "max_iterations" => contact["solver"]["max_iterations"] = whole(key, &value)?,
            "condition" | "friction" | "sources" | "targets" | "discretisation" => contact[key] = value,
            _ => {
                return Err(Failure::invalid(format!(
                    "there is no setting {key:?}; there are analysis, condition, discretisation, friction, max_iterations, solver, sources, targets, theta and tolerance"
                )));
            }
        }
        self.renew(key, contact)
    }

    fn set_analysis(&mut self, value: &Value) -> Result<(), Failure> {
        self.theta = match value.as_str() {
            Some("static") => None,
            Some("dynamic") => Some(self.theta.unwrap_or(0.5)),
            _ => {
                return Err(Failure::invalid(format!(
                    "analysis = {value}: must be \"dynamic\" or \"static\""
                )));
            }
        };
        Ok(())
    }

    /// Sets a value of one pair.
    pub fn set_pair(&mut self, between: [&str; 2], key: &str, value: Value) -> Result<(), Failure> {
        if let Some(unknown) = between.iter().find(|name| !self.names().any(|n| n == **name)) {
            let message =
                format!("there is no surface or obstacle named {unknown:?}; add it before its pairs");
            return Err(Failure::invalid(message));
        }
        let value = match key {
            "friction" | "sources" | "discretisation" => value,
            "enabled" => json!(value.as_f64() != Some(0.0)),
            _ => {
                let message = format!(
                    "there is no setting {key:?} of pairs; there are discretisation, enabled, friction and sources"
                );
                return Err(Failure::invalid(message));
            }
        };
        let mut contact = self.contact.clone();
        let Some(pairs) = contact["pairs"].as_array_mut() else { return Ok(()) };
        let at = pairs.iter().position(|pair| pair["between"] == json!(between)).unwrap_or_else(|| {
            pairs.push(
                json!({ "between": between, "friction": null, "sources": null, "discretisation": null }),
            );
            pairs.len() - 1
        });
        pairs[at][key] = value;
        self.renew(key, contact)
    }

    /// Takes the new description of contact if it is one.
    fn renew(&mut self, key: &str, contact: Value) -> Result<(), Failure> {
        let trial = json!({ "obstacles": [], "contact": contact, "theta": self.theta });
        serde_json::from_value::<PlantedSpec>(trial)
            .map_err(|e| Failure::invalid(format!("setting {key:?}: {e}")))?;
        self.contact = contact;
        Ok(())
    }

    /// Numbers the unknowns as the caller does, one number for each point and component; −1 where motion is prescribed.
    pub fn number(&mut self, unknowns: &[i32], count: usize) -> Result<(), Failure> {
        self.unknowns = Unknowns::of(unknowns, count)?;
        Ok(())
    }

    /// Contact as it has been described.
    pub fn build(&self) -> Result<Contact, Failure> {
        if self.outlines.is_empty() {
            return Err(Failure::invalid("there is no surface; give the boundary of one body at least"));
        }
        let spec = json!({ "obstacles": self.obstacles, "contact": self.contact, "theta": self.theta });
        let spec: PlantedSpec = serde_json::from_value(spec).map_err(|e| Failure::invalid(e.to_string()))?;
        let steps = match self.dimension {
            2 => self.planted::<2>(&spec)?,
            _ => self.planted::<3>(&spec)?,
        };
        let needs_velocity = self.contact["condition"] == "endpoint";
        let moves = self.obstacles.iter().any(|o| !o["velocity"].is_null());
        Ok(Contact::new(
            steps,
            [self.point_count(), self.dimension],
            self.unknowns.clone(),
            needs_velocity || moves,
        ))
    }

    fn planted<const D: usize>(&self, spec: &PlantedSpec) -> Result<Box<dyn Steps>, Failure> {
        let held = self.unknowns.held::<D>();
        let points = vectors::<D>(&self.points);
        let built = PlantedContact::build(spec, &points, &self.outlines, &held, Surfaces::new())?;
        Ok(Box::new(built))
    }
}

/// A number that counts something.
fn whole(key: &str, value: &Value) -> Result<Value, Failure> {
    match value.as_f64() {
        Some(x) if x.fract() == 0.0 && (0.0..9e15).contains(&x) => Ok(json!(x as u64)),
        _ => Err(Failure::invalid(format!("{key} = {value}: must be a whole number"))),
    }
}
