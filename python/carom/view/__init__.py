"""Pictures of bodies and their fields in space, drawn by PyVista."""

from carom.view.fields import Shown, shown
from carom.view.scene import View, animate, screenshot, show

__all__ = ["Shown", "View", "animate", "screenshot", "show", "shown"]
