"""Makes a page of every notebook in gallery/: its words, its code, and what the code prints."""

import json
from pathlib import Path

from mkdocs.structure.files import File


def on_files(files, config):
    """Add the pages; the notebooks stay beside them, to be downloaded."""
    for path in sorted(Path(config["docs_dir"], "gallery").glob("*.ipynb")):
        content = markdown(json.loads(path.read_text(encoding="utf-8")), path.name)
        files.append(File.generated(config, f"gallery/{path.stem}.md", content=content))
    return files


def markdown(notebook, name):
    """A notebook as Markdown."""
    parts = []
    for cell in notebook["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
            continue
        parts.append(f"```python\n{source}\n```")
        printed = "".join("".join(output["text"]) for output in cell["outputs"])
        if printed:
            parts.append(f"```text\n{printed.rstrip()}\n```")
    return "\n\n".join([*parts, f"[The notebook]({name}), executed and checked by a test."])
