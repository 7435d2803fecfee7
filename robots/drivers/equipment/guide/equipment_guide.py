"""A terminal page of one equipment server: its pins as they are, and its configuration to read, change and take back.

The blocking client runs in threads of the page's workers; each request has a connection of its own. It never takes
control of outputs: a new configuration is refused while another client controls, and says so.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, cast

from textual import work
from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.screen import Screen
from textual.widgets import Button, DataTable, Footer, Header, Label, TextArea

from engine.document.equipment import read_equipment
from engine.errors import FlexcellError
from robots.drivers.equipment.guide.pin_form import PinForm, with_pin
from robots.drivers.equipment.wire.equipment_client import EquipmentClient, connected_to_configure
from robots.drivers.equipment.wire.equipment_messages import ConfigurationText, PinsState

_READ_EVERY_S = 0.5
_FILE = Path("configuration")
NewClient = Callable[[], AbstractContextManager[EquipmentClient]]


def guide_equipment(host: str, port: int, *, name: str, timeout_s: float) -> None:
    """Show the page until its user leaves it.

    Raises:
        RobotError: no equipment server answers there.
    """

    def connect() -> AbstractContextManager[EquipmentClient]:
        return connected_to_configure(host, port, name=name, timeout_s=timeout_s)

    with connect() as client:
        client.configuration()
    EquipmentGuide(connect, address=f"{host}:{port}").run()


@dataclass
class RequestEnded(Message):
    """What a request has brought, for the line below the document; with `text` the document is replaced."""

    words: str
    text: str | None = None
    digest: str | None = None


@dataclass
class PinsRead(Message):
    """The pins, or why they are not known."""

    state: PinsState | None
    problem: str = ""


class EquipmentGuide(App[None]):
    """The page. What is edited is kept until it is set, or another text is read over it.

    Args:
        connect: Connects for one request; raises RobotError.
        address: For the title.
    """

    TITLE = "flexcell equipment"
    CSS = """
    #pins { width: 40%; }
    #document { height: 1fr; }
    #buttons { height: auto; }
    #form { width: 90; height: auto; padding: 1 2; border: thick $accent; background: $surface; }
    #form Horizontal { height: auto; }
    .field Label { padding: 1; }
    PinForm { align: center middle; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        ("ctrl+r", "read", "Read"),
        ("ctrl+t", "template", "Template"),
        ("ctrl+n", "add_pin", "Add a pin"),
        ("ctrl+s", "set", "Set"),
        ("ctrl+b", "roll_back", "Roll back"),
        ("ctrl+q", "quit", "Leave"),
    ]

    def __init__(self, connect: NewClient, *, address: str) -> None:
        super().__init__()
        self._connect = connect
        self._digest = ""
        self.sub_title = address

    def compose(self) -> ComposeResult:
        """Lay out pins, document and commands."""
        yield Header()
        with Horizontal():
            yield DataTable[str](id="pins", cursor_type="none")
            with Vertical():
                yield TextArea("", id="document", show_line_numbers=True, tab_behavior="indent")
                yield Label("", id="valid", markup=False)
                yield Label("", id="result", markup=False)
                with Horizontal(id="buttons"):
                    yield Button("Read", id="read")
                    yield Button("Template", id="template")
                    yield Button("Add a pin", id="add_pin")
                    yield Button("Set", id="set", variant="warning")
                    yield Button("Roll back", id="roll_back")
        yield Footer()

    def on_mount(self) -> None:
        """Read the configuration, and the pins twice a second."""
        self._table.add_columns("pin", "kind", "value")
        self.action_read()
        self._read_pins()
        self.set_interval(_READ_EVERY_S, self._read_pins)

    def on_button_pressed(self, event: Button.Pressed) -> None:
        """Do what the key of the same name does."""
        self.call_later(self.run_action, str(event.button.id))

    def on_text_area_changed(self) -> None:
        """Say at once whether the server would take the document."""
        problem = self._problem()
        self._page.query_one("#valid", Label).update(f"not valid: {problem}" if problem else "valid")

    def action_read(self) -> None:
        """Read the configuration in effect; what was edited is replaced."""

        def ask(client: EquipmentClient) -> RequestEnded:
            return _in_effect(client.configuration())

        self._request("read", ask)

    def action_template(self) -> None:
        """Show a commented example for the hardware of the server."""

        def ask(client: EquipmentClient) -> RequestEnded:
            return RequestEnded("a template; nothing is changed before it is set", text=client.template().text)

        self._request("read the template", ask)

    def action_add_pin(self) -> None:
        """Ask for a pin and add its lines."""
        self.push_screen(PinForm(), self._add)

    def action_set(self) -> None:
        """Replace the configuration; outputs go to their safe values."""
        problem = self._problem()
        if problem:
            self.on_request_ended(RequestEnded(f"not set: {problem}"))
            return
        text, base = self._text, self._digest

        def ask(client: EquipmentClient) -> RequestEnded:
            done = client.configure(text, base=base)
            digest = client.configuration().digest
            return RequestEnded(f"{done}, digest {digest[:12]}", digest=digest)

        self._request("set", ask)

    def action_roll_back(self) -> None:
        """Take back the last change; outputs go to their safe values."""
        base = self._digest

        def ask(client: EquipmentClient) -> RequestEnded:
            done = client.roll_back(base=base)
            return _in_effect(client.configuration(), after=f"{done}; ")

        self._request("roll back", ask)

    def on_request_ended(self, message: RequestEnded) -> None:
        """Show what a request has brought; it may end after the page has been left."""
        if not self.screen_stack:
            return
        self._page.query_one("#result", Label).update(message.words)
        if message.digest is not None:
            self._digest = message.digest
        if message.text is not None:
            self._show(message.text)

    def on_pins_read(self, message: PinsRead) -> None:
        """Show the pins, or why they are not known; they may come after the page has been left."""
        if not self.screen_stack:
            return
        table, state = self._table, message.state
        table.clear()
        if state is None:
            self.sub_title = message.problem
            return
        controls = f"controlled by {state.controller}" if state.controller else "nobody controls it"
        self.sub_title = state.problem or f"{state.equipment}, {controls}"
        for pin, kind in state.kinds.items():
            value = state.values.get(pin)
            table.add_row(pin, kind.replace("_", " "), "unknown" if value is None else _words(value))

    @property
    def _page(self) -> Screen[object]:
        """The screen below a form that may be open."""
        return self.screen_stack[0]

    @property
    def _table(self) -> DataTable[str]:
        return cast("DataTable[str]", self._page.query_one("#pins"))

    @property
    def _text(self) -> str:
        return self._page.query_one("#document", TextArea).text

    def _problem(self) -> str:
        """Return why the document is not valid, with its place; empty if it is."""
        try:
            read_equipment(self._text, file=_FILE)
        except FlexcellError as error:
            return str(error)
        return ""

    def _add(self, lines: str | None) -> None:
        if lines:
            self._show(with_pin(self._text, lines))

    def _show(self, text: str) -> None:
        self._page.query_one("#document", TextArea).load_text(text)

    @work(thread=True, group="request")
    def _request(self, what: str, ask: Callable[[EquipmentClient], RequestEnded]) -> None:
        try:
            with self._connect() as client:
                self.post_message(ask(client))
        except FlexcellError as error:
            self.post_message(RequestEnded(f"did not {what}: {error}"))

    @work(thread=True, group="pins", exclusive=True)
    def _read_pins(self) -> None:
        try:
            with self._connect() as client:
                self.post_message(PinsRead(client.read()))
        except FlexcellError as error:
            self.post_message(PinsRead(None, problem=str(error)))


def _in_effect(read: ConfigurationText, *, after: str = "") -> RequestEnded:
    kept = f", {len(read.kept)} earlier kept, the last of {read.kept[-1]}" if read.kept else ""
    return RequestEnded(f"{after}in effect, digest {read.digest[:12]}{kept}", text=read.text, digest=read.digest)


def _words(value: float) -> str:
    return ("on" if value else "off") if isinstance(value, bool) else f"{value:.2f}"
