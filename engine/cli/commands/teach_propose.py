"""`flexcell teach propose`: generates a behavior from taught entries, on a running server or from a cell's store."""

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
from engine.skills.proposing import Proposal, ProposalOptions, ProposeBehavior, Role, StepKind, TaughtStep
from engine.teaching.proposal_service import propose_offline
from engine.wording.suggestions import did_you_mean

_KINDS: tuple[str, ...] = get_args(StepKind)
_ROLES: tuple[str, ...] = get_args(Role)


def propose(
    steps: Annotated[
        list[str],
        typer.Argument(
            help="Entries in execution order, with `+close` and `+open` between them; `KIND:NAME` if several kinds use"
            " the name, `NAME=ROLE` to set a role explicitly (via, approach, grasp, release, depart).",
        ),
    ],
    out: Annotated[Path, typer.Option(help="File of the proposed behavior.")],
    arm: Annotated[
        str, typer.Option(help="Arm; by default the only arm, or the one whose name begins the names of the entries.")
    ] = "",
    tool: Annotated[str | None, typer.Option(help="Tool of the arm; by default the tool that the arm reports.")] = None,
    part: Annotated[str | None, typer.Option(help="Part to grasp; by default the nearest part.")] = None,
    width: Annotated[float | None, typer.Option(help="Width of the grasped part in metres.", min=0.0, max=1.0)] = None,
    approach: Annotated[
        float, typer.Option(help="Length in metres of the straight approach to a grasp or release.", min=0.001, max=0.5)
    ] = 0.1,
    speed: Annotated[float, typer.Option(help="Fraction of the joint speed limits.", min=0.01, max=1.0)] = 0.3,
    replace: Annotated[bool, typer.Option("--replace", help="Overwrite the file.")] = False,
    cell: Annotated[
        Path | None, typer.Option(help="Cell of the behavior; its store is read directly, without a running server.")
    ] = None,
    server: Annotated[Path, typer.Option(help="Folder in which `flexcell serve` keeps its state.")] = Path(
        STATE_FOLDER
    ),
) -> None:
    """Propose a behavior from taught entries: approach, grasp, transfer, release, with taught motions in between.

    `flexcell teach propose home tray_pick +close bin +open sweep --cell cells/cell.yaml --out behaviors/taught.yaml`
    """
    if out.exists() and not replace:
        raise StoreError("the file exists", where=out, hint="give another name, or --replace")
    options = ProposalOptions(
        name=out.stem, arm=arm, tool=tool, speed=speed, approach_m=approach, width_m=width,
        cell=_relative(cell, out) if cell is not None else "",
    )  # fmt: skip
    proposal = asyncio.run(
        _offline(steps, part, options, cell) if cell is not None else _on_server(steps, part, options, server)
    )
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(proposal.text, encoding="utf-8", newline="\n")
    for number, description in enumerate(proposal.words, start=1):
        sys.stdout.write(f"{number}. {description}\n")
    for remark in proposal.remarks:
        sys.stderr.write(f"flexcell: {remark}\n")


async def _offline(texts: Sequence[str], part: str | None, options: ProposalOptions, cell: Path) -> Proposal:
    async with await chosen_store(cell, None, inline=True) as store:
        keys = [(key.kind, key.name) for key in await store.list()]
        request = ProposeBehavior(steps=read_steps(texts, keys, part=part), options=options)
        return await propose_offline(store, load_cell(cell), request)


async def _on_server(texts: Sequence[str], part: str | None, options: ProposalOptions, server: Path) -> Proposal:
    async with RemoteJsonBus.connect(server) as bus:
        listed = msgspec.json.decode(await bus.call(f"store/{ListEntries.skill_name()}", {}), type=EntryList)
        steps = read_steps(texts, [(kind, name) for kind, name, _ in listed.entries], part=part)
        request = ProposeBehavior(steps=steps, options=options)
        answer = await bus.call(f"teach/{request.skill_name()}", msgspec.to_builtins(request))
        return msgspec.json.decode(answer, type=Proposal)


def read_steps(texts: Sequence[str], keys: Iterable[tuple[str, str]], *, part: str | None) -> tuple[TaughtStep, ...]:
    """Return the steps that `texts` name; `keys` are kind and name of the existing entries.

    Raises:
        SkillFailed: there is no such entry, several kinds use the name, or there is no such role.
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
    matches = [kind] if kind in kinds.get(name, ()) else [] if kind else kinds.get(name, [])
    if not matches:
        raise SkillFailed(f"there is no entry {named} that defines a motion", hint=did_you_mean(name, kinds))
    if len(matches) > 1:
        hint = " or ".join(f"{each}:{name}" for each in matches)
        raise SkillFailed(f"several kinds of entries have the name {name}", where=text, hint=hint)
    return TaughtStep(kind=cast("StepKind", matches[0]), name=name, role=chosen, part=part)


def _relative(cell: Path, out: Path) -> str:
    return Path(os.path.relpath(cell.resolve(), out.resolve().parent)).as_posix()
