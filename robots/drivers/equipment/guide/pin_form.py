"""The form that adds a pin: its lines in the document, as far as they differ from what is the default."""

from __future__ import annotations

from typing import ClassVar, cast

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.screen import ModalScreen
from textual.widgets import Button, Input, Label, Select, Switch

KINDS = {
    "digital_output": "digital output: on or off",
    "digital_input": "digital input: a sensor",
    "pwm": "output with a duty, 0 to 1",
}
SWITCHES = {
    "safe": "on is the safe value: at the start, at the end, and without a client",
    "at_stop": "STOP sets the safe value, and does not keep the present one",
    "active_low": "on is the low level, as of many relay boards",
}
_INDENT = "  "


class PinForm(ModalScreen[str]):
    """Returns the lines of the pin, or an empty text if nothing is to be added."""

    BINDINGS: ClassVar[list[BindingType]] = [("escape", "dismiss('')", "Close")]

    def compose(self) -> ComposeResult:
        """Lay out the fields."""
        with Vertical(id="form"):
            yield Label("Add a pin")
            yield Input(placeholder="name: letters, digits and _", id="name")
            choices = [(words, kind) for kind, words in KINDS.items()]
            yield Select(choices, value="digital_output", allow_blank=False, id="kind")
            yield Input(placeholder="number of the GPIO, or address of the coil or input", type="integer", id="pin")
            for field, words in SWITCHES.items():
                with Horizontal(classes="field"):
                    yield Switch(id=field)
                    yield Label(words)
            yield Label("", id="problem")
            with Horizontal():
                yield Button("Add", variant="primary", id="add")
                yield Button("Cancel", id="cancel")

    def on_button_pressed(self, event: Button.Pressed) -> None:
        """Return the lines, or say what is missing."""
        event.stop()
        if event.button.id == "cancel":
            self.dismiss("")
            return
        name, pin = self.query_one("#name", Input).value.strip(), self.query_one("#pin", Input).value.strip()
        if not name or not pin:
            self.query_one("#problem", Label).update("give a name and a number")
            return
        self.dismiss(self._lines(name, pin))

    def _lines(self, name: str, pin: str) -> str:
        kind = str(cast("Select[str]", self.query_one("#kind")).value)
        fields = {"kind": kind, "pin": pin}
        if kind != "digital_input":
            is_safe_on = self.query_one("#safe", Switch).value
            on, off = ("1.0", "0.0") if kind == "pwm" else ("true", "false")
            fields["safe"] = on if is_safe_on else off
            if self.query_one("#at_stop", Switch).value:
                fields["at_stop"] = "safe"
        if self.query_one("#active_low", Switch).value:
            fields["active_low"] = "true"
        inside = ", ".join(f"{key}: {value}" for key, value in fields.items())
        return f"{_INDENT}{name}: {{{inside}}}\n"


def with_pin(text: str, lines: str) -> str:
    """Return a document with the lines of a pin at the end of its pins, which a document of another form gets last."""
    rows = text.splitlines(keepends=True)
    begin = next((number for number, row in enumerate(rows) if row.startswith("pins:")), None)
    if begin is None:
        return text.rstrip("\n") + "\npins:\n" + lines
    end = begin + 1
    for number in range(begin + 1, len(rows)):
        if rows[number].strip() and not rows[number].startswith((" ", "#")):
            break
        if rows[number].strip():
            end = number + 1
    before = "".join(rows[:end])
    return (before if before.endswith("\n") else before + "\n") + lines + "".join(rows[end:])
