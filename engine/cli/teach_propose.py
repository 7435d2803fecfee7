"""`flexcell teach propose`: a behavior from taught entries, with a running server or from a cell's store alone."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, cast, get_args

import msgspec
import typer

from engine.bus.remote_bus import RemoteJsonBus
from engine.cli.store_access import chosen_store
from engine.document.cell import load_cell
from engine.errors import SkillFailed, StoreError
from engine.host.state_folder_names import STATE_FOLDER
from engine.skills.entries import EntryList, ListEntries
from engine.skills.proposing import Proposal, ProposalOptions, ProposeBehavior, Role, StepKind, TaughtStep, ToolName
from engine.suggestions import did_you_mean
from engine.teaching.proposal_service import propose_offline

_KINDS: tuple[str, ...] = get_args(StepKind)
_ROLES: tuple[str, ...] = get_args(Role)


def propose(
    steps: Annotated[
        list[str],
        typer.Argument(
            help="Entries in their order, `+close` and `+open` between them; `KIND:NAME` where several kinds have the"
            " name, `NAME=ROLE` where the guess is wrong (via, approach, grasp, release, depart).",
        ),
    ],
    out: Annotated[Path, typer.Option(help="File of the behavior.")],
    arm: Annotated[str, typer.Option(help="Who moves; the only arm, or the one whose name entries begin with.")] = "",
    tool: Annotated[ToolName | None, typer.Option(help="What it holds with; asked of the arm otherwise.")] = None,
    part: Annotated[str | None, typer.Option(help="What is grasped; the part that is nearest otherwise.")] = None,
    width: Annotated[float | None, typer.Option(help="Width in metres of what is grasped.", min=0.0, max=1.0)] = None,
    approach: Annotated[
        float, typer.Option(help="Straight way in metres before a grasp or release.", min=0.001, max=0.5)
    ] = 0.1,
    speed: Annotated[float, typer.Option(help="Share of the joint speed limits.", min=0.01, max=1.0)] = 0.3,
    replace: Annotated[bool, typer.Option("--replace", help="Overwrite the file.")] = False,
    cell: Annotated[
        Path | None, typer.Option(help="The cell that the behavior is for; its store is read, no server is asked.")
    ] = None,
    server: Annotated[Path, typer.Option(help="Folder in which `flexcell serve` keeps its state.")] = Path(
        STATE_FOLDER
    ),
) -> None:
    """Propose a behavior from taught entries: approach, grasp, carry, release, taught motions in between.

    `flexcell teach propose home tray_pick +close bin +open sweep --cell cells/cell.yaml --out behaviors/taught.yaml`
    """
    if out.exists() and not replace:
        raise StoreError("the file is there", where=out, hint="another name, or --replace")
    options = ProposalOptions(
        name=out.stem, arm=arm, tool=tool, speed=speed, approach_m=approach, width_m=width,
        cell=_relative(cell, out) if cell is not None else "",
    )  # fmt: skip
    made = asyncio.run(
        _offline(steps, part, options, cell) if cell is not None else _asked(steps, part, options, server)
    )
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(made.text, encoding="utf-8", newline="\n")
    for number, words in enumerate(made.words, start=1):
        sys.stdout.write(f"{number}. {words}\n")
    for remark in made.remarks:
        sys.stderr.write(f"flexcell: {remark}\n")


async def _offline(texts: Sequence[str], part: str | None, options: ProposalOptions, cell: Path) -> Proposal:
    async with await chosen_store(cell, None, inline=True) as store:
        keys = [(key.kind, key.name) for key in await store.list()]
        request = ProposeBehavior(steps=read_steps(texts, keys, part=part), options=options)
        return await propose_offline(store, load_cell(cell), request)


async def _asked(texts: Sequence[str], part: str | None, options: ProposalOptions, server: Path) -> Proposal:
    async with RemoteJsonBus.connect(server) as bus:
        listed = msgspec.json.decode(await bus.call(f"store/{ListEntries.skill_name()}", {}), type=EntryList)
        steps = read_steps(texts, [(kind, name) for kind, name, _ in listed.entries], part=part)
        request = ProposeBehavior(steps=steps, options=options)
        answer = await bus.call(f"teach/{request.skill_name()}", msgspec.to_builtins(request))
        return msgspec.json.decode(answer, type=Proposal)


def read_steps(texts: Sequence[str], keys: Iterable[tuple[str, str]], *, part: str | None) -> tuple[TaughtStep, ...]:
    """Return the steps that are named; `keys` are kind and name of the entries that there are.

    Raises:
        SkillFailed: there is no such entry, several kinds have the name, or there is no such role.
    """
    kinds: dict[str, list[str]] = {}
    for kind, name in keys:
        if kind in _KINDS:
            kinds.setdefault(name, []).append(kind)
    return tuple(_step(text, kinds, part) for text in texts)


def _step(text: str, kinds: dict[str, list[str]], part: str | None) -> TaughtStep:
    named, _, role = text.partition("=")
    if role and role not in _ROLES:
        raise SkillFailed(f"there is no role {role}", where=text, hint=did_you_mean(role, _ROLES))
    chosen = cast("Role | None", role or None)
    if named.startswith("+"):
        return TaughtStep(kind="action", name=named[1:], role=chosen, part=part)
    kind, _, name = named.rpartition(":")
    found = [kind] if kind in kinds.get(name, ()) else [] if kind else kinds.get(name, [])
    if not found:
        raise SkillFailed(f"there is no entry {named} that a motion can be made of", hint=did_you_mean(name, kinds))
    if len(found) > 1:
        hint = " or ".join(f"{each}:{name}" for each in found)
        raise SkillFailed(f"several kinds of entries are called {name}", where=text, hint=hint)
    return TaughtStep(kind=cast("StepKind", found[0]), name=name, role=chosen, part=part)


def _relative(cell: Path, out: Path) -> str:
    return Path(os.path.relpath(cell.resolve(), out.resolve().parent)).as_posix()
