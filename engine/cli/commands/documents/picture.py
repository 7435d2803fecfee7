"""`flexcell picture`: draws a whole behavior into a file."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated

import typer

from engine.authoring.yaml_export import to_yaml
from engine.cli.inputs import read_behavior, read_text
from engine.document.python_name import is_python_name
from engine.editing.analysis.diagnostics import draw_document
from engine.editing.analysis.document_graph import DocumentNode
from engine.editing.pictures import PictureRequest, draw_svg, pdf_of, png_of
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft
from engine.editing.text.outline import Outline
from engine.editing.versions import write_atomically
from engine.errors import DocumentError, FlexcellError
from engine.registry import load_states
from engine.wording import did_you_mean

_FORMATS: Mapping[str, Callable[[str], bytes]] = {".svg": str.encode, ".png": png_of, ".pdf": pdf_of}


def picture(
    behavior: Annotated[
        Path, typer.Argument(help="The behavior document, or FILE.py:NAME of one in Python.", show_default=False)
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", help="The file to write, .svg, .png or .pdf.", show_default=False)
    ],
    dark: Annotated[bool, typer.Option("--dark", help="In the colours of the dark theme.")] = False,
    all_: Annotated[
        bool, typer.Option("--all", help="Open every container; default: those that the page opens by itself.")
    ] = False,
    depth: Annotated[
        int | None,
        typer.Option("--depth", min=0, help="Open the containers of so many levels, and no others; 0 opens none."),
    ] = None,
    open_: Annotated[
        list[str] | None,
        typer.Option("--open", metavar="PATH", help="Open this container too, such as `root/pick`; repeatable."),
    ] = None,
) -> None:
    """Draw a whole behavior, as the page exports it. A behavior with errors is drawn as far as it can be read."""
    write = _FORMATS.get(output.suffix.lower())
    if write is None:
        raise FlexcellError(f"{output} is no picture", hint="give a name that ends in .svg, .png or .pdf")
    if all_ and depth is not None:
        raise FlexcellError("--all and --depth say different things", hint="give one of them")
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
    opened = tuple(open_ or ())
    _require_containers(graph, opened)
    scheme = "dark" if dark else "light"
    request = PictureRequest(graph=graph, document=analysis.document, scheme=scheme, all=all_, depth=depth, open=opened)
    made = write(draw_svg(request))
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(output, made)
    except OSError as error:
        hint = "check its folder and the free space"
        raise FlexcellError(f"the file cannot be written: {error.strerror}", where=output, hint=hint) from error
    sys.stderr.write(f"wrote {output}\n")


def _require_containers(graph: DocumentNode, paths: tuple[str, ...]) -> None:
    """Raise FlexcellError where a path is that of no node with others inside."""
    containers = {node.path for node in _nodes(graph) if node.children}
    for path in paths:
        if path not in containers:
            raise FlexcellError(f"--open {path}: there is no such container", hint=did_you_mean(path, containers))


def _nodes(node: DocumentNode) -> Iterator[DocumentNode]:
    yield node
    for child in node.children:
        yield from _nodes(child)
