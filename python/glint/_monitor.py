# SPDX-License-Identifier: MIT
"""Long calls tell how far they are, and end early when the caller wants it."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

from . import _abi
from ._abi import Phase

Progress = Callable[[Phase, float], object]


class Monitor:
    """A GlintMonitor for one call, to be used as a context around it.

    An exception in the caller's progress function, or of a signal such as Ctrl-C, cannot pass
    through C. It is kept, makes the library cancel, and goes on at the end of the context. Signals
    have a handler of ours meanwhile: an exception of another could strike outside of any `try`.
    """

    def __init__(self, progress: Progress | None) -> None:
        self.progress = progress
        self.raised: BaseException | None = None
        self.handler: Any = None
        members: dict[str, Any] = dict(_abi.GlintMonitor._fields_)
        self.struct = _abi.GlintMonitor(
            members["progress"](self.on_progress), members["cancelled"](self.on_cancelled), None
        )

    def on_progress(self, _user: object, phase: int, fraction: float) -> None:
        if self.progress is None or self.raised is not None:
            return
        try:
            self.progress(Phase(phase), fraction)
        except BaseException as error:
            self.raised = error

    def on_cancelled(self, _user: object) -> bool:
        return self.raised is not None

    def on_signal(self, number: int, frame: FrameType | None) -> None:
        try:
            self.handler(number, frame)
        except BaseException as error:
            self.raised = self.raised or error

    def __enter__(self) -> Any:
        # Only the main thread hears of signals, and may say who handles them.
        if threading.current_thread() is threading.main_thread():
            handler = signal.getsignal(signal.SIGINT)
            if callable(handler):
                self.handler = handler
                signal.signal(signal.SIGINT, self.on_signal)
        return self.struct

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self.handler is not None:
            signal.signal(signal.SIGINT, self.handler)
        if self.raised is not None:
            raise self.raised from None
