"""CasADi's scalar operations, of which the compilers of loops translate some."""

from __future__ import annotations

import casadi as ca

from onpath.models.errors import CodedError


def no_translation(owner: str, operation: int, target: str) -> CodedError:
    """The error of an operation that a compiler does not translate.

    Args:
        owner: the law or function that contains it.
        operation: CasADi's number of it, one of `ca.OP_*`.
        target: what it would be translated to.
    """
    names = (name for name, code in vars(ca).items() if name[:3] == "OP_" and code == operation)
    name = next(names, str(operation))
    return CodedError("error.no_translation", owner=owner, operation=name, target=target)
