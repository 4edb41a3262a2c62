"""For properties of which one example costs a tenth of a second: few of the examples of the profile."""

from hypothesis import settings

costly = settings(max_examples=max(4, settings.default.max_examples // 4))
