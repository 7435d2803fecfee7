"""The styles of the page: colours in one file, modules beside components, the kit's buttons, and few lines in all."""

from __future__ import annotations

import re
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "editor_web" / "frontend" / "src"
TOKENS = SOURCE / "app" / "styles" / "tokens.css"
HEX = re.compile(r"#(?:[0-9a-fA-F]{8}|[0-9a-fA-F]{6}|[0-9a-fA-F]{3,4})\b(?![\w-])")
RAW_BUTTON = re.compile(r"<button\b")
# A class that is looked up by a status can be any one.
COMPUTED = re.compile(r"\b(?:styles|classes)\[(?!')")
CLASS = re.compile(r"\.([a-zA-Z][\w-]*)")

# Lines of all style sheets together.
CEILING_LINES = 2500


def _styles() -> list[Path]:
    return sorted(SOURCE.rglob("*.css"))


def _components() -> list[Path]:
    return [file for file in sorted(SOURCE.rglob("*.tsx")) if not file.name.endswith(".test.tsx")]


def _folder(file: Path) -> str:
    """`editor` of a file in `features/editor`, `app` of one in `app`."""
    parts = file.relative_to(SOURCE).parts
    return parts[1] if parts[0] == "features" else parts[0]


def _text(file: Path) -> str:
    return re.sub(r"/\*.*?\*/", "", file.read_text(encoding="utf-8"), flags=re.DOTALL)


def test_colours_stand_in_the_tokens_only() -> None:
    """Else a theme, or more contrast, would leave some of them out."""
    assert HEX.search(_text(TOKENS))
    sources = [*_styles(), *_components(), *(file for file in SOURCE.rglob("*.ts") if ".test." not in file.name)]
    found = [
        f"{file.relative_to(SOURCE)}: {colour}"
        for file in sources
        if file != TOKENS
        for colour in HEX.findall(_text(file))
    ]
    assert not found, "write var(--…) of app/styles/tokens.css: " + ", ".join(found)


def test_buttons_are_those_of_the_kit() -> None:
    """Only what stops the cell does without it: that must work where the kit has failed."""
    raw = {file for file in _components() if RAW_BUTTON.search(_text(file))}
    assert {_folder(file) for file in raw} >= {"stop"}, "STOP must not depend on the component kit"
    found = [str(file.relative_to(SOURCE)) for file in raw if _folder(file) != "stop"]
    assert not found, "use Button, ActionIcon, UnstyledButton or Anchor of the kit: " + ", ".join(sorted(found))


def test_styles_are_modules() -> None:
    """A class of one component cannot change another one; what holds for the whole page stands in app/styles."""
    found = [
        str(file.relative_to(SOURCE))
        for file in _styles()
        if not file.name.endswith(".module.css") and file.parent != TOKENS.parent
    ]
    assert not found, "name it X.module.css, beside X.tsx: " + ", ".join(found)


def test_no_class_is_left_that_nothing_uses() -> None:
    """A class of a module stands in a file that imports the module."""
    users = {file: file.read_text(encoding="utf-8") for file in (*SOURCE.rglob("*.ts"), *SOURCE.rglob("*.tsx"))}
    found: list[str] = []
    for module in SOURCE.rglob("*.module.css"):
        importing = [text for text in users.values() if f"/{module.name}'" in text]
        if any(COMPUTED.search(text) for text in importing):
            continue
        names = set(CLASS.findall(re.sub(r":global\([^)]*\)", "", _text(module))))
        found += [
            f"{module.relative_to(SOURCE)}: .{name}"
            for name in sorted(names)
            if not any(re.search(rf"\.{name}\b|\['{name}'\]", text) for text in importing)
        ]
    assert not found, "delete: " + ", ".join(found)


def test_there_are_few_lines_of_styles() -> None:
    """Layout, text and surfaces are the kit's; what it lacks is little."""
    lines = sum(len(file.read_text(encoding="utf-8").splitlines()) for file in _styles())
    assert lines <= CEILING_LINES, f"{lines} lines of styles: use the components of the kit and their props"
