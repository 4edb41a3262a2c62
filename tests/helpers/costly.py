"""For properties of which one example costs a tenth of a second: a fifth of the examples of the profile."""

from hypothesis import settings

costly = settings(max_examples=max(10, settings.default.max_examples // 5))
