"""Why a certificate is not accepted."""

from __future__ import annotations

SHOWN = 80


def plain(text: str) -> str:
    """A text that a terminal shows as it is: control characters and the like are escaped."""
    return text if text.isprintable() else ascii(text)


class Refused(Exception):
    """A certificate does not show what it states: what is wrong, the value found, and the rule it breaks."""

    def __init__(self, subject: str, value: object, rule: str) -> None:
        text, rule = plain(str(value)), plain(rule)
        self.subject, self.rule = plain(subject), rule
        self.value = text if len(text) <= SHOWN else text[: SHOWN - 1] + "…"
        super().__init__(f"{self.subject} = {self.value}: {rule}" if text else f"{self.subject}: {rule}")


def require(holds: object, subject: str, value: object, rule: str) -> None:
    """Refuse unless something is true."""
    if holds is not True:
        raise Refused(subject, value, rule)
