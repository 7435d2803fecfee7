"""The engine: documents, runs, bus, journal and store; independent of robots and browsers.

Importing it makes every module of the project prepare its message and document types on import;
two threads that prepared a type at once would crash the process, see `engine.type_preparation`.
"""

from engine.type_preparation import prepare_on_import

prepare_on_import("engine", "states", "robots", "editor_web", "behaviors")
