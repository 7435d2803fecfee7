"""`flexcell states`: lists the available states and describes one of them."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated, cast

import msgspec
import typer
from rich.console import Console
from rich.table import Table

from engine.document.signature import KeySignature, StateSignature, read_signature
from engine.document.state_catalogue import Catalogue, find_state
from engine.registry import load_states, state_by_path
from engine.state import State

app = typer.Typer(help="List the states that behaviors can use, and describe one.", invoke_without_command=True)

AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]


@app.callback()
def list_states(context: typer.Context, json: AsJson = False) -> None:
    """List all states; `states show NAME` describes one."""
    if context.invoked_subcommand is not None:
        return
    catalogue = load_states(Path.cwd())
    sys.stderr.writelines(f"flexcell: {failure}\n" for failure in catalogue.broken.values())
    signatures = _signatures(catalogue)
    if json:
        sys.stdout.write(msgspec.json.encode([_as_dict(signature) for signature in signatures]).decode() + "\n")
        return
    table = Table("state", "outcomes", "description", box=None)
    for signature in signatures:
        table.add_row(signature.name, " ".join(signature.outcomes), signature.summary)
    Console().print(table)


@app.command("show")
def show(
    name: Annotated[str, typer.Argument(help="State, such as motion.MoveJoints, or package.module:Class.")],
    json: AsJson = False,
) -> None:
    """Show the parameters, input keys, output keys and outcomes of one state."""
    signature = read_signature(_find(name))
    if json:
        sys.stdout.write(msgspec.json.encode(_as_dict(signature)).decode() + "\n")
        return
    console = Console(highlight=False)
    console.print(f"[bold]{signature.name}[/]\n{signature.doc}\n")
    console.print(f"outcomes: {', '.join(signature.outcomes)}")
    for title, rows in _tables(signature).items():
        if rows:
            table = Table(title, "type", "default", "description", box=None)
            for row in rows:
                table.add_row(*row)
            console.print(table)


def _signatures(catalogue: Catalogue) -> list[StateSignature]:
    """Return the signature of every state once, under the name that documents use."""
    signatures = [(name, read_signature(state)) for name, state in catalogue.items()]
    return [replace(each, name=name) for name, each in signatures if name == each.name or each.name not in catalogue]


def _find(name: str) -> type[State]:
    catalogue = load_states(Path.cwd())
    # A user who gives a module name on the command line wants it imported; documents cannot import modules.
    return state_by_path(name) if ":" in name and name not in catalogue else find_state(catalogue, name)


def _tables(signature: StateSignature) -> dict[str, list[tuple[str, str, str, str]]]:
    return {
        "parameter": [
            (name, type_text(parameter), default_text(parameter), description(parameter))
            for name, parameter in signature.parameters.items()
        ],
        "input key": [(name, type_text(key), default_text(key), "") for name, key in signature.inputs.items()],
        "output key": [(name, type_text(key), "", "") for name, key in signature.outputs.items()],
    }


def _as_dict(signature: StateSignature) -> dict[str, object]:
    return {
        "name": signature.name,
        "description": signature.doc,
        "outcomes": signature.outcomes,
        "success": signature.success,
        "parameters": {name: parameter.schema for name, parameter in signature.parameters.items()},
        "inputs": {name: key.schema for name, key in signature.inputs.items()},
        "outputs": {name: key.schema for name, key in signature.outputs.items()},
    }


def type_text(key: KeySignature) -> str:
    """Return a type with its limits as short text, such as `number > 0, <= 1`."""
    schema = key.schema
    limits = {"exclusiveMinimum": ">", "minimum": ">=", "exclusiveMaximum": "<", "maximum": "<="}
    bounds = [f"{sign} {schema[name]}" for name, sign in limits.items() if name in schema]
    kind = schema.get("type") or _alternatives(schema)
    unit = schema.get("unit")
    return " ".join(part for part in (str(kind), ", ".join(bounds), f"[{unit}]" if unit else "") if part)


def default_text(key: KeySignature) -> str:
    """Return the default as JSON, or `required` if there is none."""
    return "required" if key.required else msgspec.json.encode(key.default).decode()


def description(key: KeySignature) -> str:
    """Return the description that the author of the state wrote."""
    return str(key.schema.get("description", ""))


def _alternatives(schema: Mapping[str, object]) -> str:
    if "$ref" in schema:
        return str(schema["$ref"]).rpartition("/")[2]
    choices = schema.get("enum")
    if isinstance(choices, list):
        return ", ".join(msgspec.json.encode(each).decode() for each in cast("list[object]", choices))
    options = schema.get("anyOf")
    if isinstance(options, list):
        schemas = msgspec.convert(options, list[dict[str, object]])
        return " or ".join(str(option.get("type") or _alternatives(option)) for option in schemas)
    return "any"
