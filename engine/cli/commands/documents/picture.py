"""`flexcell picture`: draws a whole behavior into a file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from engine.authoring.yaml_export import to_yaml
from engine.cli.inputs import read_behavior, read_text
from engine.document.python_name import is_python_name
from engine.editing.analysis.diagnostics import draw_document
from engine.editing.picture import PictureRequest, draw_svg, png_of
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft
from engine.editing.text.outline import Outline
from engine.editing.versions import write_atomically
from engine.errors import DocumentError, FlexcellError
from engine.registry import load_states

_FORMATS = (".svg", ".png")


def picture(
    behavior: Annotated[
        Path, typer.Argument(help="The behavior document, or FILE.py:NAME of one in Python.", show_default=False)
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", help="The file to write, .svg or .png.", show_default=False)
    ],
    dark: Annotated[bool, typer.Option("--dark", help="In the colours of the dark theme.")] = False,
    all_: Annotated[
        bool, typer.Option("--all", help="Open every container; default: those that the page opens by itself.")
    ] = False,
) -> None:
    """Draw a whole behavior, as the page exports it. A behavior with errors is drawn as far as it can be read."""
    if output.suffix.lower() not in _FORMATS:
        raise FlexcellError(f"{output} is no picture", hint="give a name that ends in .svg or .png")
    states = load_states(behavior)
    if is_python_name(str(behavior)):
        text = to_yaml(read_behavior(behavior, states)[0])
        file = Path(str(behavior).partition(":")[0]).with_suffix(".yaml")
    else:
        text, file = read_text(behavior), behavior
    context = ProjectContext(states, file.parent, Path(file.absolute().anchor))
    draft = Draft(text, file=str(file))
    analysis, drawn = draw_document(draft, Outline(draft.data), file=file, context=context)
    graph = drawn.whole()
    if graph is None or analysis.document is None:
        raise DocumentError("this document has no nodes", where=str(file))
    request = PictureRequest(graph=graph, document=analysis.document, scheme="dark" if dark else "light", all=all_)
    svg = draw_svg(request)
    made = svg.encode() if output.suffix.lower() == ".svg" else png_of(svg)
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(output, made)
    except OSError as error:
        hint = "check its folder and the free space"
        raise FlexcellError(f"the file cannot be written: {error.strerror}", where=output, hint=hint) from error
    sys.stderr.write(f"wrote {output}\n")
