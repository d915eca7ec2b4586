"""Arguments of a wrong type, told as the caller knows the function."""

from __future__ import annotations

import functools
import inspect
from typing import Any, Callable, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])


def told_as_called(function: Function) -> Function:
    """What the extension says of arguments that it cannot take names its own functions: say it of this one."""

    @functools.wraps(function)
    def call(*arguments: Any, **keys: Any) -> Any:
        try:
            return function(*arguments, **keys)
        except TypeError as error:
            if "incompatible function arguments" not in str(error):
                raise
            name = function.__qualname__
        given = ", ".join([type(a).__name__ for a in arguments] + [f"{k}: {type(v).__name__}" for k, v in keys.items()])
        raise TypeError(f"{name}() was given ({given}); expected {name}{inspect.signature(function)}; fix: help(pitviper.{name})")

    return call  # type: ignore[return-value]
