"""Write the reference pages: ``python -m docs.generate``. With ``--check`` name those that differ."""

import ast
import contextlib
import inspect
import json
import os
import re
import subprocess
import sys
from argparse import SUPPRESS
from functools import cached_property
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).parents[1]
REFERENCE = ROOT / "docs" / "reference"
sys.path.insert(0, str(ROOT))

from docs.file_keys import FILES  # noqa: E402

NOTE = "<!-- Written by `python -m docs.generate`. Do not edit. -->\n"
EXIT_CODES = {
    "0": "Everything is proved or accepted.",
    "1": "Something is refuted or rejected.",
    "2": "The input cannot be used.",
    "3": "Something is undecided and nothing is refuted.",
    "4": "Internal error.",
    "130, 143, 141": "Interrupted, terminated, or nobody reads the output.",
}
"""Of all commands; a command says in `Exit code …` what they mean for it."""


def table(head, rows):
    """A Markdown table; cells may hold any text."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(map(cell, line)) + " |\n" for line in lines)


def cell(text):
    """Text that ends no cell and starts no tag."""
    return re.sub(
        r"<(?=[A-Za-z/!])", "&lt;", re.sub(r"\s+", " ", str(text)).replace("|", r"\|").replace("``", "`")
    )


# --- Commands.


def commands():
    """One page for each command, and one that lists them."""
    from lyapcheck.cli.commands import NAMES, load
    from lyapcheck.cli.parser import Parser

    rows, pages = [], {}
    for name in NAMES:
        module = load(name)
        parser = Parser(prog=f"lyapcheck {name}")
        module.arguments(parser)
        text = inspect.cleandoc(module.run.__doc__)
        rows.append([f"[`lyapcheck {name}`](commands/{name}.md)", text.partition("\n")[0]])
        pages[f"commands/{name}.md"] = command_page(name, text, parser)
    shared = "Every command has `--help`. The exit codes are the same for all commands.\n\n"
    shared += table(["code", "meaning"], EXIT_CODES.items())
    pages["commands.md"] = f"# Commands\n\n{table(['command', 'purpose'], rows)}\n{shared}"
    return pages


def command_page(name, text, parser):
    """What a command does and takes, with its examples and the keys of its JSON."""
    about, _, examples = text.partition("Examples:\n")
    own = re.search(r"^Exit code (.*?)\n\n", about, re.DOTALL | re.MULTILINE)
    about = about.replace(own[0], "") if own else about
    usage = parser.usage.replace("%(prog)s", parser.prog)
    parts = [f"# lyapcheck {name}", paragraphs(about), f"```text\n{usage}\n```"]
    groups = {"Arguments": [], "Options": []}
    for action in parser.actions:
        if action.help is SUPPRESS:
            continue
        value = action.metavar or (action.dest.upper() if action.nargs != 0 else "")
        called = ", ".join(action.option_strings) or value
        shown = f"{called} {value}" if action.option_strings and action.nargs != 0 else called
        about = (action.help or "").replace("%(default)s", str(action.default)).replace("%%", "%")
        repeated = type(action).__name__ == "_AppendAction" and "repeated" not in about
        groups["Options" if action.option_strings else "Arguments"].append(
            [f"`{shown}`", about + (" May be repeated." if repeated else "")]
        )
    for title, rows in groups.items():
        if rows:
            parts.append(f"## {title}\n\n{table([title.lower()[:-1], 'meaning'], rows)}")
    lines = [line.strip() for line in examples.splitlines() if line.strip()]
    if lines:
        parts.append("## Examples\n\n```console\n" + "\n".join(f"$ {line}" for line in lines) + "\n```")
    said = re.findall(r"(\d): (.*?)(?:, (?=\d: )|\.?$)", " ".join(own[1].split())) if own else ()
    codes = {code: f"{meaning[:1].upper()}{meaning[1:]}." for code, meaning in said}
    codes |= {
        code: says
        for code, says in EXIT_CODES.items()
        if code not in codes and (not said or code not in "0123")
    }
    codes = dict(sorted(codes.items(), key=lambda row: (len(row[0]), row[0])))
    parts.append(f"## Exit codes\n\n{table(['code', 'meaning'], codes.items())}")
    return "\n\n".join(parts)


# --- JSON: the keys of an answer to one small question for each command.


GAINS = """robot = "pendulum1"
[[gains]]
name = "one"
m = 1
kp = [10]
kv = [0.5]
"""
PLAN = 'robots = ["pendulum1"]\nquestions = ["gate"]\n[grid]\nm = [1]\nkp = [10]\nkv = [0.5]\n'
ASKED = {
    "bounds": "bounds gains.toml --time 1",
    "check": "check published.py --n 1 --m 1 --only 19 --certificates certificates",
    "derive": "derive --m 1",
    "epsilon": "epsilon gains.toml --max-boxes 1000",
    "explain": "explain 19",
    "export": "export gains.toml --rate 1000 --out controller",
    "gate": "gate gains.toml",
    "recheck": "recheck certificates",
    "robot": "robot pendulum1",
    "simulate": "simulate gains.toml --time 1",
    "sweep": "sweep plan.toml --out sweep",
    "table": "table --m 1",
    "tune": "tune pendulum1 --m 1",
}


def json_sections():
    """The section on JSON of each command that can be asked quickly."""
    result = {}
    with TemporaryDirectory() as folder:
        Path(folder, "gains.toml").write_text(GAINS, encoding="utf-8")
        Path(folder, "plan.toml").write_text(PLAN, encoding="utf-8")
        kept = {"XDG_CACHE_HOME": str(Path(folder, "cache"))}
        for name, line in ASKED.items():
            words = [sys.executable, "-m", "lyapcheck", *line.split(), "--format", "json"]
            done = subprocess.run(
                words, cwd=folder, capture_output=True, text=True, check=False, env=os.environ | kept
            )
            data = json.loads(done.stdout)
            rows = [[f"`{key}`", ", ".join(sorted(kinds))] for key, kinds in keys_of(data).items()]
            about = (
                f"The keys of the answer to `lyapcheck {line} --format json`, schema `{data['schema']}`.\n"
            )
            result[f"commands/{name}.md"] = f"\n\n## JSON\n\n{about}\n{table(['key', 'type'], rows)}"
    return result


TYPES = {dict: "object", list: "list", str: "text", bool: "true or false", int: "number", float: "number"}


def keys_of(data, path="", found=None):
    """The types at every path of a JSON document; ``[]`` stands for each entry of a list."""
    found = {} if found is None else found
    if path:
        found.setdefault(path, set()).add(TYPES.get(type(data), "null"))
    if isinstance(data, dict) and path != "versions":
        for key, value in data.items():
            keys_of(value, f"{path}.{key}" if path else key, found)
    elif isinstance(data, list):
        for value in data:
            if isinstance(value, dict):
                keys_of(value, f"{path}[]", found)
    return {key: kinds for key, kinds in found.items() if not key.endswith("]")}


# --- Files.


HEADS = {
    "gain": ("Gain files", "A gain file (TOML) lists gain sets for one arm. Decimals are read exactly."),
    "arm": (
        "Arm files",
        "An arm file (TOML) describes an arm by its links, by printed formulas, or by a URDF file. "
        "A number may be a plain decimal or a table that also has its source and range.",
    ),
    "plan": ("Plan files", "A plan file (TOML) names the arms, gains and questions of `lyapcheck sweep`."),
    "reference": (
        "Reference files",
        "A reference file (TOML) describes a trajectory q_d(t) for `lyapcheck simulate --reference`.",
    ),
}


def files():
    """One page for each kind of file, and one that lists them."""
    pages, rows = {}, []
    for kind, tables in FILES.items():
        title, about = HEADS[kind]
        parts = [f"# {title}", about]
        for name, keys in tables.items():
            lines = [[f"`{k.name}`", k.type, k.unit, k.default, code(k.example), k.about] for k in keys]
            heading = f"`{name}`" if name and name[0] in "[kir" and "number" not in name else name
            parts.append(f"## {heading or 'Top of the file'}")
            parts.append(table(["key", "type", "unit", "default", "example", "meaning"], lines))
        pages[f"{kind}_files.md"] = "\n\n".join(parts)
        rows.append([f"[{title}]({kind}_files.md)", about])
    pages["files.md"] = "# Files\n\n" + table(["file", "purpose"], rows)
    return pages


def code(example):
    """An example as code, and a pointer as text."""
    return example if example.startswith("see ") else f"`{example}`"


# --- Names of Python.


TASKS = {
    "claims.claim": "Write a proof script",
    "claims.script": "Use another proof script",
    "claims.expressions": "Write expressions",
    "claims.statements": "State what is claimed",
    "claims.letters": "State a claim for any number of joints",
    "claims.bounds": "Use an arm and its bounds",
    "claims.goals": "Use the closed loop",
    "claims.arguments": "Use a stability theorem",
    "check": "Build a statement directly",
}
ROOMS = {"answers": "Answers", "control": "Gains", "robots": "Arms", "simulate": "Simulation"}


def claims():
    """The names of ``lyapcheck.claims`` by task."""
    module = import_module("lyapcheck.claims")
    homes = {}
    tree = ast.parse(Path(module.__file__).read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith("lyapcheck."):
            homes |= {
                alias.asname or alias.name: node.module.removeprefix("lyapcheck.") for alias in node.names
            }
    head = "# Names of lyapcheck.claims\n\nA proof script imports these names from `lyapcheck.claims`."
    groups = {task: [] for task in TASKS.values()}
    for name in sorted(module.__all__, key=str.lower):
        home = homes.get(name, "")
        task = TASKS.get(home) or TASKS.get(home.partition(".")[0]) or "Other"
        groups.setdefault(task, []).append(entry(name, getattr(module, name)))
    return {"claims.md": by_group(head, groups)}


def python_names():
    """The public names of the package by room."""
    import lyapcheck

    groups = {task: [] for task in ROOMS.values()}
    for name in sorted(set(lyapcheck.__all__) - {"__version__"}, key=str.lower):
        room = lyapcheck._HOMES[name].partition(".")[0]
        groups.setdefault(ROOMS.get(room, "More"), []).append(entry(name, getattr(lyapcheck, name)))
    head = "# Names of lyapcheck\n\nAll public names. [Python](python.md) lists the functions by task."
    return {"python_names.md": by_group(head, groups)}


def by_group(head, groups):
    """A page with a section for each group that has entries."""
    parts = [f"## {group}\n\n" + "\n\n".join(entries) for group, entries in groups.items() if entries]
    return "\n\n".join([head, *parts])


def entry(name, value):
    """The signature and documentation of a name."""
    signature = ""
    if callable(value) and not (inspect.isclass(value) and issubclass(value, BaseException)):
        with contextlib.suppress(ValueError, TypeError):
            plain = str(inspect.signature(value))
            signature = re.sub(r"\blyapcheck\.[\w.]*\.|'", "", re.sub(r"<([\w.]+)[^>]*>", r"\1", plain))
    text = inspect.getdoc(value) if inspect.isclass(value) or callable(value) else ""
    parts = [f"### {name}", f"```text\n{wrapped(name + signature)}\n```", paragraphs(text or "")]
    if inspect.isclass(value):
        rows = [
            [f"`{member}`", (inspect.getdoc(kept) or "").partition("\n\n")[0]]
            for member, kept in vars(value).items()
            if member[0] != "_"
            and (callable(kept) or isinstance(kept, (property, cached_property, classmethod, staticmethod)))
        ]
        if rows:
            parts.append(table(["member", "meaning"], rows))
    return "\n\n".join(part for part in parts if part)


def wrapped(text):
    """A signature; one too long for a line has a line for each argument."""
    if len(text) <= 90:
        return text
    depth, result = 0, []
    for letter in text:
        depth += (letter in "([") - (letter in ")]")
        result.append(letter)
        if depth == 1 and letter in "(,":
            result.append("\n   " if letter == "," else "\n    ")
    return "".join(result)


def paragraphs(text):
    """A docstring as Markdown: its sections become lists, its indented lines and examples code."""
    result, inside = [], False
    for block in re.split(r"\n\s*\n", text.strip()):
        first, _, rest = block.partition("\n")
        section = re.fullmatch(r"(Args|Returns|Raises|References|Soundness|Yields|Attributes):\s*(.*)", first)
        if block.lstrip().startswith(">>>"):
            result.append(f"```python\n{inspect.cleandoc(block)}\n```")
        elif section:
            items = [section[2]] if section[2] else []
            for line in inspect.cleandoc(rest).splitlines():
                if items and line.startswith(" "):
                    items[-1] += f" {line.strip()}"
                else:
                    items.append(line)
            result.append(f"{section[1]}:\n\n" + "\n".join(f"- {cell(item)}" for item in items if item))
        elif all(line.startswith("  ") for line in block.splitlines()) or inside:
            result.append(f"```text\n{inspect.cleandoc(block)}\n```")
        elif "\n  " in block:
            top = [line for line in block.splitlines() if not line.startswith("  ")]
            deep = [line for line in block.splitlines() if line.startswith("  ")]
            result.append(f"{plain(' '.join(top))}\n\n```text\n{inspect.cleandoc(chr(10).join(deep))}\n```")
        else:
            result.append(plain(" ".join(block.splitlines())))
    return "\n\n".join(result)


def plain(text):
    """Prose of a docstring: doubled backticks are single in Markdown, and nothing else has a meaning."""
    text = text.replace("``", "`")
    text = re.sub(r"<(?=[A-Za-z/!])", "&lt;", text)
    return "".join(
        part if number % 2 else re.sub(r"([*_\[\]$])", r"\\\1", part)
        for number, part in enumerate(re.split(r"(`[^`]*`)", text))
    )


# --- Messages.


REFUSALS = {"fail": 2, "argument_error": 2, "file_error": 2}
"""The functions that refuse input; their last arguments are the rule and the repair."""


def messages():
    """The rule and the repair of each refusal that the code has."""
    found = {}
    for path in sorted((ROOT / "lyapcheck").rglob("*.py")):
        room = path.relative_to(ROOT / "lyapcheck").parts[0]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            called = getattr(node, "func", None)
            name = getattr(called, "attr", getattr(called, "id", ""))
            if isinstance(node, ast.Call) and name in REFUSALS and len(node.args) >= 3:
                rule, repair = (template(part) for part in node.args[-2:])
                if rule and repair:
                    found.setdefault(room, set()).add((rule, repair))
    head = (
        "# Messages\n\nA message names the place, the value, the rule and the repair. "
        "An ellipsis stands for a value of your input."
    )
    return {
        "messages.md": by_group(
            head, {f"`{room}`": [table(["rule", "repair"], sorted(rows))] for room, rows in found.items()}
        )
    }


def template(node):
    """A text with an ellipsis for each value; empty where the text is made elsewhere."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "…" for part in node.values)
    return ""


# --- All pages.


def pages(answers=True):
    """The generated pages by path below ``docs/reference``, with or without the keys of JSON answers."""
    result = commands() | files() | claims() | python_names() | messages()
    for path, section in json_sections().items() if answers else ():
        result[path] += section
    return {path: f"{NOTE}\n{text.rstrip()}\n" for path, text in result.items()}


def main(words):
    """Write the pages, or name those that differ."""
    wanted = pages()
    have = {
        str(path.relative_to(REFERENCE)): path.read_text(encoding="utf-8") for path in REFERENCE.rglob("*.md")
    }
    changed = [path for path, text in wanted.items() if have.get(path) != text]
    surplus = [
        path for path in (REFERENCE / "commands").glob("*.md") if f"commands/{path.name}" not in wanted
    ]
    if "--check" in words:
        print(*changed, *surplus, sep="\n")
        return 1 if changed or surplus else 0
    for path in surplus:
        path.unlink()
    for path in changed:
        (REFERENCE / path).parent.mkdir(parents=True, exist_ok=True)
        (REFERENCE / path).write_text(wanted[path], encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
