use std::fmt::Debug;
use std::ops::Range;

use carom_mesh::parallel::{each_chunk, has_threads};
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;

use super::last_panel::LastPanel;
use super::pieces::pieces;
use super::real::Real;
use super::row::{self, ABREAST, Row};
use super::substitution::Substitution;

/// Numbers that a factor is kept in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// `f32`: half the memory, and as solves wait for memory, half the time. For an iteration whose residual is exact it is enough,
    /// unless the matrix is so ill-conditioned that errors of 10⁻⁷ matter.
    Single,
    /// `f64`.
    #[default]
    Double,
}

impl Precision {
    /// An empty factor in this precision.
    pub(super) fn triangular(self) -> Box<dyn Triangular> {
        match self {
            Self::Single => Box::new(Halves::<f32>::new()),
            Self::Double => Box::new(Halves::<f64>::new()),
        }
    }
}

/// A triangular factor and a right-hand side on its way through both substitutions. A place is a position in the order of elimination.
pub(super) trait Triangular: Debug + Send + Sync {
    /// Memory [bytes].
    fn bytes(&self) -> usize;
    /// Whether threads can share the factor's work.
    #[cfg(test)]
    fn is_apart(&self) -> bool;
    /// Takes over the values of a factor whose k-th column is that of the unknown `ordering[k]`.
    fn load(&mut self, factor: &SupernodalLltRef<'_, usize, f64>, ordering: &[usize]);
    /// Takes the right-hand side `x` through the forward substitution.
    fn begin(&mut self, x: &[f64]);
    /// The backward substitution: writes the solution to `x`.
    fn end(&mut self, x: &mut [f64]);
    /// Names the places at which the solution is wanted before the end, and the right-hand side is added to.
    fn set_reach(&mut self, places: &mut dyn Iterator<Item = usize>);
    /// Solves for the right-hand side as it is, within the reach.
    fn look(&mut self);
    /// What was seen at a place of the reach.
    fn seen(&self, place: usize) -> f64;
    /// Solves for the unit vectors of [`ABREAST`] places of the reach at most, within the reach.
    fn respond(&mut self, places: &[usize]);
    /// The solution for the unit vector of such a place, named by its number among them, at a place of the reach.
    fn response(&self, number: usize, place: usize) -> f64;
    /// Adds values at places of the reach to the right-hand side.
    fn add(&mut self, values: &mut dyn Iterator<Item = (usize, f64)>);
}

/// A factor in pieces that do not depend on one another, and what depends on them, the top. A small one is all top.
///
/// Sums are taken piece by piece, with one thread as with many.
#[derive(Debug)]
struct Halves<T> {
    pieces: Vec<Piece<T>>,
    top: Piece<T>,
    /// The right-hand side and what becomes of it: the vectors of the pieces one after the other, then that of the top.
    ordered: Vec<T>,
    /// The same within the reach.
    partial: Vec<T>,
    /// Solutions for unit vectors within the reach, alike; empty until there are any.
    abreast: Vec<Row<T>>,
    /// The same where the reach is most of the last panel, and nothing else.
    last_panel: LastPanel<T>,
    /// Columns of the top, if so.
    in_last_panel: Option<Range<usize>>,
    /// Where in these the value of every column is.
    position: Vec<u32>,
    /// Where the value of every unknown is.
    position_of_unknown: Vec<u32>,
}

/// Some of the columns of a factor.
#[derive(Debug, Default)]
struct Piece<T> {
    substitution: Substitution<T>,
    /// Its part of the vectors.
    range: Range<usize>,
    /// The unknowns of its own columns.
    unknowns: Vec<u32>,
    /// For every row of the top that its columns have: the column of the top.
    outside: Vec<u32>,
    reach: Vec<u32>,
    /// The reach of the unit vectors alone.
    path: Vec<u32>,
    /// Columns that a reach is wanted of.
    wanted: Vec<u32>,
}

impl<T: Real> Piece<T> {
    /// Copies the part of its own columns from `x`, and clears the rest.
    fn collect(&self, x: &[f64], values: &mut [T]) {
        let (own, outside) = values.split_at_mut(self.unknowns.len());
        for (value, &unknown) in own.iter_mut().zip(&self.unknowns) {
            *value = T::of(x[unknown as usize]);
        }
        outside.fill(T::default());
    }

    /// Gives what its columns leave to the top, to be added there.
    fn hand_up<V>(&self, values: &[V], top: &mut [V], add: impl Fn(&mut V, &V)) {
        for (value, &column) in values[self.unknowns.len()..].iter().zip(&self.outside) {
            add(&mut top[column as usize], value);
        }
    }

    /// Takes the solution of the top.
    fn take_down<V: Copy>(&self, values: &mut [V], top: &[V]) {
        for (value, &column) in values[self.unknowns.len()..].iter_mut().zip(&self.outside) {
            *value = top[column as usize];
        }
    }

    /// Clears what is within the reach.
    fn clear<V: Copy>(&self, values: &mut [V], zero: V) {
        self.substitution.columns_within(&self.reach).for_each(|columns| values[columns].fill(zero));
        values[self.unknowns.len()..].fill(zero);
    }
}

/// Calls `work` with every piece and its part of `values`, which starts with that of the first.
fn each_piece<T: Real, V: Send>(
    pieces: &mut [Piece<T>],
    values: &mut [V],
    work: &(dyn Fn(&mut Piece<T>, &mut [V]) + Sync),
) {
    match pieces {
        [] => {}
        [piece] => work(piece, values),
        _ => {
            let (left, right) = pieces.split_at_mut(pieces.len() / 2);
            let (of_left, of_right) = values.split_at_mut(right[0].range.start - left[0].range.start);
            if has_threads() {
                rayon::join(|| each_piece(left, of_left, work), || each_piece(right, of_right, work));
            } else {
                each_piece(left, of_left, work);
                each_piece(right, of_right, work);
            }
        }
    }
}

impl<T: Real> Halves<T> {
    fn new() -> Self {
        Self {
            pieces: Vec::new(),
            top: Piece::default(),
            ordered: Vec::new(),
            partial: Vec::new(),
            abreast: Vec::new(),
            last_panel: LastPanel::default(),
            in_last_panel: None,
            position: Vec::new(),
            position_of_unknown: Vec::new(),
        }
    }

    /// The columns of the top from the first in the reach on, where that is in the last panel and the reach is most of them.
    fn ask_in_last_panel(&self) -> Option<Range<usize>> {
        let Piece { substitution, reach, wanted, .. } = &self.top;
        let (&[panel], Some(last)) = (&reach[..], substitution.panels.last()) else { return None };
        let is_alone = panel as usize + 1 == substitution.panels.len()
            && self.pieces.iter().all(|piece| piece.reach.is_empty());
        let first = wanted.iter().min().filter(|_| is_alone)?;
        let columns = *first as usize..last.start + last.columns;
        (2 * wanted.len() >= columns.len()).then_some(columns)
    }

    /// The piece that a position belongs to, as an index; that behind the last is the top.
    fn piece_at(&self, position: usize) -> usize {
        self.pieces.partition_point(|piece| piece.range.end <= position)
    }
}

impl<T: Real> Triangular for Halves<T> {
    fn bytes(&self) -> usize {
        let pieces = self.pieces.iter().chain([&self.top]);
        let own: usize = pieces.map(|p| p.substitution.bytes() + size_of_val(&p.unknowns[..])).sum();
        let own = own + self.last_panel.bytes();
        let vectors = 2 * size_of_val(&self.ordered[..]) + size_of_val(&self.abreast[..]);
        own + vectors + 2 * size_of_val(&self.position[..])
    }

    #[cfg(test)]
    fn is_apart(&self) -> bool {
        self.pieces.len() > 1
    }

    fn load(&mut self, factor: &SupernodalLltRef<'_, usize, f64>, ordering: &[usize]) {
        let count = factor.symbolic().n_supernodes();
        let mut supernode_of = vec![0_u32; ordering.len()];
        let columns = |s: usize| {
            let supernode = factor.supernode(s);
            supernode.start()..supernode.start() + supernode.val().ncols()
        };
        (0..count).for_each(|s| supernode_of[columns(s)].fill(s as u32));
        let above = |s: usize| {
            factor.supernode(s).pattern().first().map_or(usize::MAX, |&row| supernode_of[row] as usize)
        };
        let parent: Vec<usize> = (0..count).map(above).collect();
        let size = |s: usize| {
            let supernode = factor.supernode(s);
            supernode.val().ncols() * (supernode.val().ncols() + supernode.pattern().len())
        };
        let ranges = pieces(&parent, &(0..count).map(size).collect::<Vec<usize>>());

        // The columns of the top, by those of the factor.
        const NONE: u32 = u32::MAX;
        let mut in_piece = vec![false; count];
        ranges.iter().for_each(|range| in_piece[range.clone()].fill(true));
        let of_top = || (0..count).filter(|&s| !in_piece[s]);
        let mut place_in_top = vec![NONE; ordering.len()];
        let mut unknowns = Vec::new();
        for column in of_top().flat_map(columns) {
            place_in_top[column] = unknowns.len() as u32;
            unknowns.push(ordering[column] as u32);
        }

        self.pieces.clear();
        self.last_panel.clear();
        self.position = vec![0; ordering.len()];
        let mut start = 0;
        let mut place_outside = vec![NONE; ordering.len()];
        for range in ranges {
            let own = columns(range.start).start..columns(range.end - 1).end;
            let mut piece = Piece::<T> {
                unknowns: ordering[own.clone()].iter().map(|&unknown| unknown as u32).collect(),
                ..Piece::default()
            };
            let outside = &mut piece.outside;
            piece.substitution.load(factor, range, |column| {
                if own.contains(&column) {
                    return (column - own.start) as u32;
                }
                if place_outside[column] == NONE {
                    place_outside[column] = (own.len() + outside.len()) as u32;
                    outside.push(column as u32);
                }
                place_outside[column]
            });
            for column in outside {
                place_outside[*column as usize] = NONE;
                *column = place_in_top[*column as usize];
            }
            piece.range = start..start + own.len() + piece.outside.len();
            own.enumerate().for_each(|(k, column)| self.position[column] = (start + k) as u32);
            start = piece.range.end;
            self.pieces.push(piece);
        }
        self.top = Piece { range: start..start + unknowns.len(), unknowns, ..Piece::default() };
        self.top.substitution.load(factor, of_top(), |column| place_in_top[column]);
        for (position, place) in
            self.position.iter_mut().zip(&place_in_top).filter(|(_, place)| **place != NONE)
        {
            *position = start as u32 + place;
        }
        self.position_of_unknown = vec![0; ordering.len()];
        for (&unknown, &position) in ordering.iter().zip(&self.position) {
            self.position_of_unknown[unknown] = position;
        }
        self.ordered = vec![T::default(); self.top.range.end];
        self.partial = self.ordered.clone();
    }

    fn begin(&mut self, x: &[f64]) {
        let Self { pieces, top, ordered, .. } = self;
        let (of_pieces, of_top) = ordered.split_at_mut(top.range.start);
        each_piece(pieces, of_pieces, &|piece, values| {
            piece.collect(x, values);
            piece.substitution.forward(values);
        });
        top.collect(x, of_top);
        pieces
            .iter()
            .for_each(|piece| piece.hand_up(&of_pieces[piece.range.clone()], of_top, |t, v| *t += *v));
        top.substitution.forward(of_top);
    }

    fn end(&mut self, x: &mut [f64]) {
        let Self { pieces, top, ordered, position_of_unknown, .. } = self;
        let (of_pieces, of_top) = ordered.split_at_mut(top.range.start);
        top.substitution.backward(of_top);
        let of_top = &*of_top;
        each_piece(pieces, of_pieces, &|piece, values| {
            piece.take_down(values, of_top);
            piece.substitution.backward(values);
        });
        each_chunk(x, |first, x| {
            for (x, &position) in x.iter_mut().zip(&position_of_unknown[first..]) {
                *x = ordered[position as usize].to_f64();
            }
        });
    }

    fn set_reach(&mut self, places: &mut dyn Iterator<Item = usize>) {
        self.find(places, |piece| &mut piece.reach);
        self.in_last_panel = self.ask_in_last_panel();
    }

    fn look(&mut self) {
        let Self { pieces, top, ordered, partial, .. } = self;
        for piece in pieces.iter().chain([&*top]) {
            for columns in piece.substitution.columns_within(&piece.reach) {
                let columns = piece.range.start + columns.start..piece.range.start + columns.end;
                partial[columns.clone()].copy_from_slice(&ordered[columns]);
            }
        }
        self.backward_within_reach();
    }

    fn seen(&self, place: usize) -> f64 {
        self.partial[self.position[place] as usize].to_f64()
    }

    fn respond(&mut self, places: &[usize]) {
        if let Some(columns) = self.in_last_panel.clone() {
            let Self { top, last_panel, position, .. } = self;
            let asked = places.iter().map(|&place| position[place] as usize - top.range.start);
            last_panel.ask(asked, columns, |own| top.substitution.end_of_last_panel(own));
            return;
        }
        self.last_panel.ask_for_none();
        self.find(&mut places.iter().copied(), |piece| &mut piece.path);
        self.abreast.resize(self.ordered.len(), [T::default(); ABREAST]);
        let Self { pieces, top, abreast, position, .. } = self;
        for piece in pieces.iter().filter(|piece| !piece.reach.is_empty()).chain([&*top]) {
            piece.clear(&mut abreast[piece.range.clone()], [T::default(); ABREAST]);
        }
        for (number, &place) in places.iter().enumerate() {
            abreast[position[place] as usize][number] = T::of(1.0);
        }
        let (of_pieces, of_top) = abreast.split_at_mut(top.range.start);
        for piece in pieces.iter_mut().filter(|piece| !piece.path.is_empty()) {
            let values = &mut of_pieces[piece.range.clone()];
            piece.substitution.forward_abreast(&piece.path, values);
            piece.hand_up(values, of_top, row::add);
        }
        top.substitution.forward_abreast(&top.path, of_top);
        top.substitution.backward_abreast(&top.reach, of_top);
        let of_top = &*of_top;
        each_piece(pieces, of_pieces, &|piece, values| {
            if !piece.reach.is_empty() {
                piece.take_down(values, of_top);
                piece.substitution.backward_abreast(&piece.reach, values);
            }
        });
    }

    fn response(&self, number: usize, place: usize) -> f64 {
        let position = self.position[place] as usize;
        let answer = self.last_panel.answer(number, || position - self.top.range.start);
        answer.unwrap_or_else(|| self.abreast[position][number]).to_f64()
    }

    fn add(&mut self, values: &mut dyn Iterator<Item = (usize, f64)>) {
        let Self { pieces, top, ordered, partial, position, .. } = self;
        for piece in pieces.iter().filter(|piece| !piece.reach.is_empty()).chain([&*top]) {
            piece.clear(&mut partial[piece.range.clone()], T::default());
        }
        values.for_each(|(place, value)| partial[position[place] as usize] += T::of(value));
        let (of_pieces, of_top) = partial.split_at_mut(top.range.start);
        each_piece(pieces, of_pieces, &|piece, values| {
            piece.substitution.forward_within(&piece.reach, values);
        });
        for piece in pieces.iter().filter(|piece| !piece.reach.is_empty()) {
            piece.hand_up(&of_pieces[piece.range.clone()], of_top, |t, v| *t += *v);
        }
        top.substitution.forward_within(&top.reach, of_top);
        for piece in pieces.iter().chain([&*top]) {
            for columns in piece.substitution.columns_within(&piece.reach) {
                let columns = piece.range.start + columns.start..piece.range.start + columns.end;
                let (ordered, partial) = (&mut ordered[columns.clone()], &partial[columns]);
                ordered.iter_mut().zip(partial).for_each(|(ordered, partial)| *ordered += *partial);
            }
        }
    }
}

impl<T: Real> Halves<T> {
    /// Writes what the right-hand sides in `places` touch to a list of every piece.
    fn find(&mut self, places: &mut dyn Iterator<Item = usize>, list: fn(&mut Piece<T>) -> &mut Vec<u32>) {
        self.pieces.iter_mut().chain([&mut self.top]).for_each(|piece| piece.wanted.clear());
        for place in places {
            let position = self.position[place] as usize;
            let k = self.piece_at(position);
            let piece = self.pieces.get_mut(k).unwrap_or(&mut self.top);
            piece.wanted.push((position - piece.range.start) as u32);
        }
        let Self { pieces, top, .. } = self;
        for piece in pieces {
            let mut found = std::mem::take(list(piece));
            let wanted = piece.wanted.iter().map(|&column| column as usize);
            piece.substitution.reach(wanted, &mut found, |row| {
                top.wanted.push(piece.outside[row - piece.unknowns.len()]);
            });
            *list(piece) = found;
        }
        let mut found = std::mem::take(list(top));
        top.substitution.reach(top.wanted.iter().map(|&column| column as usize), &mut found, |_| {});
        *list(top) = found;
    }

    /// The backward substitution of `partial` within the reach.
    fn backward_within_reach(&mut self) {
        let Self { pieces, top, partial, .. } = self;
        let (of_pieces, of_top) = partial.split_at_mut(top.range.start);
        top.substitution.backward_within(&top.reach, of_top);
        let of_top = &*of_top;
        each_piece(pieces, of_pieces, &|piece, values| {
            if !piece.reach.is_empty() {
                piece.take_down(values, of_top);
                piece.substitution.backward_within(&piece.reach, values);
            }
        });
    }
}
