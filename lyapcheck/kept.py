"""Answers kept between runs: certificates by the digest of what was asked, judged again when they are taken.

A certificate that the checker does not accept, or that is about another thing than what is asked now, makes
the whole answer unknown: it is computed anew. Plain data beside the certificates say how they were found, and
decide nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from lyapcheck import store
from lyapcheck.certificate import Certificate
from lyapcheck.check import certificate as read
from lyapcheck.check.certificate import certificate_of, judge
from lyapcheck.check.refusal import Refused
from lyapcheck.computing import shared_between

T = TypeVar("T")
BROKEN = (Refused, AttributeError, KeyError, TypeError, ValueError, ZeroDivisionError)
"""What comes of data that another program, or another person, has written."""


@dataclass(frozen=True)
class KeptCertificates:
    """An answer as it is kept.

    Args:
        certificates: by name, what the answer rests on.
        beside: plain data.
    """

    certificates: Mapping[str, read.Certificate]
    beside: Mapping[str, Any] = field(default_factory=dict)


def remembered(
    question: Mapping[str, Any],
    rebuilt: Callable[[KeptCertificates], T | None],
    compute: Callable[[], T],
    written: Callable[[T], KeptCertificates | None],
    jobs: int = 1,
) -> T:
    """The answer to a question: from what is kept, where that holds, else computed now and kept.

    Args:
        question: plain data.
        rebuilt: the answer from accepted certificates; ``None`` where they are not about what is asked.
        compute: the answer.
        written: an answer as it is kept; ``None`` where it is not worth it.
        jobs: processes that may share a certificate.
    """
    if store.off():
        return compute()
    result = _taken(question, rebuilt, jobs)
    if result is None:
        result = compute()
        if (one := written(result)) is not None:
            texts = {name: Certificate.of(each).text() for name, each in one.certificates.items()}
            store.put(question, {"certificates": texts, "beside": one.beside})
    return result


def _taken(
    question: Mapping[str, Any], rebuilt: Callable[[KeptCertificates], T | None], jobs: int
) -> T | None:
    answer = store.take(question)
    if answer is None:
        return None
    try:
        texts: dict[str, str] = answer["certificates"]
        found = {name: certificate_of(text.encode())[0] for name, text in texts.items()}
        with shared_between(jobs):
            for one in found.values():
                judge(one)
        return rebuilt(KeptCertificates(found, answer["beside"]))
    except BROKEN:
        return None
