"""Measure the prose of the project: ``python -m tests.house.prose`` compares each text with its limits.

A text has at most 18 words per sentence. At most 8 % of its sentences have over 30 words, and 15 % a ``;`` or
``:`` inside. It has no pattern of ``PATTERNS``. ``prose.json`` records texts of code that are worse. They may
only improve.
"""

import argparse
import importlib
import inspect
import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
RECORD = Path(__file__).with_name("prose.json")
LIMITS = {"words": 18, "long": 8, "joined": 15, "hits": 0}
PATTERNS = {
    "start with the thing": r"^(What|Who|Whoever|Whatever|Whether|That no|How)\b[^?]*$",
    "name the result, the input": r"(?<!^)\bwhat (is|was|are|it|they|one|you|the|an?|no|has|must|may|can)\b",
    "next to, compared with": r"\bbeside\b",
    "instead of": r"\bin place of\b",
    "repeat the noun": r"\b(that|those) of\b",
    "reported, listed": r"\b(is|are|was|were|be) (told|said)\b",
    "per, for each": r"\b(one|two|once|row|line) an? (joint|file|command|kind|worker|row|claim|gain)\b",
    "again, from then on, alone": r"\b(anew|for good|all the same|by (itself|themselves)|(th|wh)ereby)\b",
    "uses, reaches, stops": r"\b(comes? (to|of|near|within)|came of|goes? by|ends? (at|in)|dies? out)\b",
    "if, when": r"(^|\b)where (it|they|there|none|no|neither|that|this|those|these|all|asked|known|a|an)\b",
    "contains, reports": r"\b(file|gate|checker|report|command|row|rule|page|it)s? (says?|tells?|knows?)\b",
    "say it positively": r"\b(need not|not un\w+|no \w+ (do|does) (better|worse)|is not (not|un\w+))\b",
    "assumes": r"\b(takes?|taken|take) for granted\b",
    "is next to, is in": r"\bstands? (beside|with|in|behind|at)\b",
    "assumes, receives": r"\b(supposes?|supposed|handed|hands)\b",
    "name it": r"\b(has|had|have) (none|not)[,.;)]",
    "also, before the verb": r", too[,.;)]",
    "subject first": r", (no|nothing|none|neither) \w+ (says|shows|tells|knows)\b",
    "a sentence of its own": r"\([^()]{70,}\)",
    "see the glossary": r"\b(ways? round|letters|spare|pays for|resisted|dearest|doubts)\b",
}


def paragraphs(text):
    """The prose of a Markdown text: no code, tables, headings, pictures and comments."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r"(?ms)^\s*(```|~~~).*?^\s*\1\s*$", "\n", text)
    text = re.sub(r"(?m)^\s*(\||#|!\[|\[!\[|:::|    options|<).*$", "\n", text)
    text = re.sub(r"(?m)^\s*([-*]|\d+\.)\s+", "\n\n", text)
    return [" ".join(part.split()) for part in re.split(r"\n\s*\n", text) if part.strip()]


def sentences(paragraph):
    """Its sentences of three words or more, without marks of Markdown; code counts as a word."""
    paragraph = re.sub(r"`[^`]*`", "code", paragraph)
    plain = re.sub(r"[*_]+", "", re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", paragraph))
    plain = re.sub(r"\b(e\.g|i\.e|et al|cf)\.", r"\1", plain)
    parts = re.split(r"(?<=[.!?])\s+(?=[A-Z“\"(0-9λεγ–—-])", plain)
    return [part for part in parts if len(re.findall(r"[A-Za-z]{2,}", part)) >= 3]


def faults(text):
    """Each pattern found: the words, and what to write."""
    for paragraph in paragraphs(text):
        for sentence in sentences(paragraph):
            for advice, pattern in PATTERNS.items():
                yield from ((match[0].strip(), advice) for match in re.finditer(pattern, sentence))


def measure(text):
    """The four numbers of a text that LIMITS limits."""
    found = [one for paragraph in paragraphs(text) for one in sentences(paragraph)]
    count, lengths = max(len(found), 1), [len(one.split()) for one in found]
    return {
        "words": round(sum(lengths) / count, 1),
        "long": round(100 * sum(length > 30 for length in lengths) / count),
        "joined": round(100 * sum(bool(re.search(r"[;:]\s", one[:-1])) for one in found) / count),
        "hits": sum(1 for _ in faults(text)),
    }


def worse(numbers, before):
    """The numbers beyond their limits and beyond a record of before."""
    return {name: value for name, value in numbers.items() if value > max(before.get(name, 0), LIMITS[name])}


def texts():
    """Every page by its path, then the help of all commands and the docstrings of public names."""
    docs = ROOT / "docs"
    every = [*ROOT.glob("*.md"), *docs.rglob("*.md"), *docs.rglob("*.ipynb")]
    # help texts and docstrings are measured where they stand, not in the pages written from them
    pages = [page for page in every if not page.read_text(encoding="utf-8").startswith("<!-- Written by")]
    result = {str(page.relative_to(ROOT)): _words(page) for page in sorted(pages)}
    return result | {"help": _help()} | {name: _public(name) for name in ("lyapcheck", "lyapcheck.claims")}


def _words(page):
    text = page.read_text(encoding="utf-8")
    if page.suffix == ".md":
        return text
    cells = json.loads(text)["cells"]
    return "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown")


def _help():
    from lyapcheck.cli.commands import NAMES, load
    from lyapcheck.cli.parser import Parser

    parts = []
    for name in NAMES:
        parser = Parser(prog=name)
        load(name).arguments(parser)
        parts += [action.help for action in parser._actions if action.help]
        parts.append(inspect.getdoc(load(name).run).partition("Examples:")[0])
    return "\n\n".join(parts)


def _public(module):
    home = importlib.import_module(module)
    docs = [inspect.getdoc(getattr(home, name)) or "" for name in home.__all__ if name != "__version__"]
    names = "Args|Returns|Raises|Attributes|Examples?|Yields|Soundness|References"
    heads = rf"(?m)^ *({names}):[ \t]*|^ *>>>.*$|^ {{4,}}[\w*, ]+: "
    return re.sub(heads, "\n\n", "\n\n".join(docs))


def main():
    """One line for each text beyond its limits; exit code 1 if there is one."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--show", metavar="TEXT", action="append", default=[], help="list its faults")
    parser.add_argument("--save", action="store_true", help="record the texts of code as they are")
    args = parser.parse_args()
    all_texts = texts()
    for name in args.show:
        print(name, measure(all_texts[name]))
        print(*(f"  “{words}” → {advice}" for words, advice in faults(all_texts[name])), sep="\n")
    numbers = {name: measure(text) for name, text in all_texts.items()}
    if args.save:
        beyond = {
            name: row
            for name, row in numbers.items()
            if not name.endswith((".md", ".ipynb")) and worse(row, {})
        }
        RECORD.write_text(json.dumps(beyond, indent=1) + "\n", encoding="utf-8")
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    bad = {name: found for name, row in numbers.items() if (found := worse(row, record.get(name, {})))}
    for name, found in bad.items():
        print(f"{name}: {', '.join(f'{key} {value}, at most {LIMITS[key]}' for key, value in found.items())}")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main())
