"""Pictures and films of results: bodies as they deform, in the colours of a field."""

from carom.view.fields import Shown, shown

__all__ = ["Shown", "shown"]
