"""`flexcell devices`: connects to the real devices of a cell, reads, and reports; commands nothing."""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path
from typing import Annotated

import msgspec
import typer

from engine.cell.drivers import (
    AssignedDriver,
    DeviceContext,
    DeviceReport,
    Driver,
    DriverOptions,
    assigned_drivers,
    installed_drivers,
)
from engine.cli.capture_option import Capture, capture_folder
from engine.cli.exit_code import ExitCode
from engine.clock import new_clock
from engine.document.cell import load_cell
from engine.errors import FlexcellError

_READINGS = 50


def devices(
    cell: Annotated[Path | None, typer.Argument(help="Cell document; without one, the installed drivers.")] = None,
    capture: Capture = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Read the real devices of a cell and report them; without a cell, list the installed drivers. Nothing moves.

    Exit code 0: every device answers. 1: one does not, or has a fault. 2: the cell is not valid.

    `flexcell devices cell.yaml --capture traces`
    """
    if cell is None:
        _print_drivers(json=json)
        return
    reports = asyncio.run(_read_all(tuple(assigned_drivers(load_cell(cell))), capture_folder(capture)))
    if json:
        sys.stdout.write(msgspec.json.encode(reports).decode() + "\n")
    elif not reports:
        sys.stdout.write("all devices of this cell are simulated\n")
    else:
        sys.stdout.write("\n".join(_text(report) for report in reports))
    if any(report.error or report.fault for report in reports):
        raise typer.Exit(ExitCode.OTHER_OUTCOME)


async def _read_all(assigned: tuple[AssignedDriver, ...], capture: Path | None) -> list[DeviceReport]:
    ready = [(each, driver := each.driver(), each.options(driver)) for each in assigned]
    return [await _read(each, driver, options, capture) for each, driver, options in ready]


async def _read(assigned: AssignedDriver, driver: Driver, options: DriverOptions, capture: Path | None) -> DeviceReport:
    name = assigned.device_name(driver)
    context = DeviceContext(cell=assigned.cell, robot=assigned.robot, capture=capture)
    device = driver.new_device(options, name=name, clock=new_clock(), context=context)
    try:
        async with device:
            return await device.report(readings=_READINGS)
    except FlexcellError as error:
        cause = error.__cause__ if isinstance(error.__cause__, FlexcellError) else error
        return DeviceReport(
            device=name,
            driver=driver.kind,
            address=str(cause.where or ""),
            capabilities=tuple(sorted(driver.configured(options).capabilities)),
            proven=driver.proven,
            error=cause.message,
            hint=error.hint or "",
        )


def _text(report: DeviceReport) -> str:
    lines = [f"{report.device}: driver {report.driver} at {report.address}"]
    if report.error:
        lines += [f"no answer: {report.error}", *([f"check: {report.hint}"] if report.hint else [])]
    else:
        lines += [f"state: {report.state}", f"fault: {report.fault or 'none'}"]
        lines += [f"firmware: {report.firmware or 'the device does not report it'}"]
        lines += [f"{name}: {value:g}" for name, value in report.readings.items()]
        lines += [_digital("inputs", report.inputs), _digital("outputs", report.outputs)]
        trip = report.round_trip
        if trip is not None:
            times = "/".join(f"{1e3 * value:.1f}" for value in (trip.min_s, trip.median_s, trip.max_s))
            lines.append(f"round trip: {times} ms (min/median/max of {trip.readings} readings)")
        offset = report.clock_offset_s
        lines.append(f"clock offset: {f'{1e3 * offset:.1f} ms' if offset is not None else 'the device has no clock'}")
    lines += [f"can do: {', '.join(report.capabilities)}", f"proven: {report.proven}"]
    return "\n  ".join(line for line in lines if line) + "\n"


def _digital(what: str, values: tuple[bool, ...]) -> str:
    """Return which digital inputs or outputs are on; empty for a device without them."""
    on = [str(number) for number, value in enumerate(values) if value]
    return f"{what} on: {', '.join(on) or 'none'} of 0 to {len(values) - 1}" if values else ""


def _print_drivers(*, json: bool) -> None:
    drivers = installed_drivers().values()
    if json:
        rows = [
            {
                "kind": each.kind,
                "drives": each.drives,
                "models": sorted(each.models),
                "capabilities": sorted(each.capabilities),
                "ports": each.ports,
                "proven": each.proven,
                "page": each.page,
            }
            for each in drivers
        ]
        sys.stdout.write(msgspec.json.encode(rows).decode() + "\n")
        return
    for each in drivers:
        ports = ", ".join(f"{name} {port}" for name, port in each.ports.items()) or "none"
        sys.stdout.write(
            f"{each.kind}: drives {', '.join(sorted(each.models)) or each.drives}\n"
            f"  can do: {', '.join(sorted(each.capabilities))}\n  default ports: {ports}\n"
            f"  proven: {each.proven}\n  page: {each.page}\n"
        )
