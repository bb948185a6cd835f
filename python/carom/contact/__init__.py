"""Contact in time loops of your own: search, gap, frame, exact friction, books.

Your code knows its bodies and its unknowns; what touches, and with which forces, is found here by
the functions that carom's own step uses. In a step of your loop,

1. `ContactModel.search` finds what may touch,
2. `ContactModel.evaluate` says which of that takes part, with gaps, frames and H,
3. `solve` finds reactions and motion from any function that solves with your K̄,
4. `ContactModel.missed` says whether something was not foreseen,
5. `ContactModel.accept` ends the step and says what its reactions did; a `Ledger` adds that up.
"""

from carom.contact.contacts import Candidates, Contacts
from carom.contact.ledger import Ledger, PairWork, Step
from carom.contact.model import ContactModel
from carom.contact.solve import Solution, solve
from carom.contact.surface import Surface

__all__ = [
    "Candidates",
    "ContactModel",
    "Contacts",
    "Ledger",
    "PairWork",
    "Solution",
    "Step",
    "Surface",
    "solve",
]
