"""What can go wrong."""


class MesoscopeError(Exception):
    """A failure of mesoscope: its message says what happened, where, and what to do."""

    def __init__(self, message: str, mistakes: list[tuple[str, str]] | None = None) -> None:
        super().__init__(message)
        #: Places and texts of all mistakes, where there may be several.
        self.mistakes = list(mistakes or [])


class SceneError(MesoscopeError, ValueError):
    """A scene or settings that are not accepted: ``mistakes`` has the path and the text of each."""


class ArrayError(MesoscopeError, ValueError):
    """Arrays or numbers that do not fit a simulation."""


class AdapterError(MesoscopeError, RuntimeError):
    """No usable adapter, or one that failed."""


class UnstableError(MesoscopeError, ArithmeticError):
    """A run or a simulation whose numbers left the range in which they mean anything."""


class FileError(MesoscopeError, OSError):
    """A file that cannot be read or written, or is not what it was."""


class RunError(MesoscopeError, RuntimeError):
    """Any other failure."""
