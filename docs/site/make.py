#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes a static site of the documentation: make.py SOURCE FOLDER

The pages are README.md and those of docs/ that `pages` lists, converted by Python-Markdown; links between
them, pictures and links into the sources are put right. Every link within the site must lead somewhere:
otherwise the script says which does not and ends with 1.
"""
import html
import pathlib
import posixpath
import re
import shutil
import sys

import markdown

# Title in the menu, page; a heading has no page.
pages = [
    ("Begin", None),
    ("First picture", "README.md"),
    ("Gallery", "docs/gallery.md"),
    ("For students", "docs/students.md"),
    ("For teachers", "docs/teachers.md"),
    ("Reference", None),
    ("The scene format", "docs/scene-format.md"),
    ("Elements", "docs/elements.md"),
    ("The command line", "docs/command-line.md"),
    ("Check", "docs/check.md"),
    ("Why", "docs/why.md"),
    ("Grade", "docs/grade.md"),
    ("Watch", "docs/watch.md"),
    ("Views", "docs/views.md"),
    ("Formatting, upgrading", "docs/format-tools.md"),
    ("Programs", None),
    ("The library", "docs/library.md"),
    ("Python", "docs/python.md"),
    ("Installing", "docs/install.md"),
    ("How it is built", None),
    ("The numbers", "docs/performance.md"),
    ("Accuracy", "docs/accuracy.md"),
    ("Sampling", "docs/sampling.md"),
    ("Architecture", "docs/architecture.md"),
    ("Contributing", "CONTRIBUTING.md"),
    ("Changes", "CHANGELOG.md"),
]
STYLE = """
:root { color-scheme: light dark; --line: #8884; --soft: #8881; --link: #0b62a4; }
@media (prefers-color-scheme: dark) { :root { --link: #7cc0f4; } }
* { box-sizing: border-box; }
body { margin: 0; font: 16px/1.55 system-ui, sans-serif; display: flex; }
nav { flex: 0 0 15em; padding: 1.5em 1em; border-right: 1px solid var(--line); height: 100vh;
      position: sticky; top: 0; overflow: auto; }
nav h2 { font-size: .8em; text-transform: uppercase; letter-spacing: .06em; margin: 1.4em 0 .3em; }
nav a { display: block; padding: .1em 0; text-decoration: none; }
nav a[aria-current] { font-weight: 600; }
main { flex: 1 1 auto; min-width: 0; max-width: 54em; padding: 1.5em 2.5em 4em; }
a { color: var(--link); }
h1 { line-height: 1.2; }
h2 { margin-top: 2em; border-bottom: 1px solid var(--line); }
pre { background: var(--soft); padding: .8em 1em; overflow-x: auto; border-radius: 6px; line-height: 1.4; }
code { font: .9em ui-monospace, monospace; }
img, svg { max-width: 100%; height: auto; }
table { border-collapse: collapse; display: block; overflow-x: auto; }
th, td { border-bottom: 1px solid var(--line); padding: .3em .8em .3em 0; text-align: left; vertical-align: top; }
@media (max-width: 50em) { body { display: block; } nav { position: static; height: auto; border: 0; }
                           main { padding: 1em; } }
"""
LINK = re.compile(r'(href|src)="([^"]+)"')


def target(page):
    """Where a page stands in the site."""
    if page == "README.md":
        return "index.html"
    return posixpath.basename(page)[:-3].lower() + ".html"


class Site:
    def __init__(self, source, folder):
        self.source, self.folder, self.faults, self.anchors = source, folder, [], {}
        self.pages = [(title, page) for title, page in pages
                      if page is None or (source / page).is_file()]
        for i in reversed(range(len(self.pages))):
            empty = i + 1 == len(self.pages) or self.pages[i + 1][1] is None
            if self.pages[i][1] is None and empty:
                del self.pages[i]
        self.known = {page for _, page in self.pages if page}

    def menu(self, current):
        lines = ['<nav aria-label="Pages">']
        for title, page in self.pages:
            if page is None:
                lines.append(f"<h2>{title}</h2>")
                continue
            here = ' aria-current="page"' if page == current else ""
            lines.append(f'<a href="{target(page)}"{here}>{title}</a>')
        return "\n".join(lines + ["</nav>"])

    def link(self, page, match):
        """A link as it stands in a page, as it must stand in the site."""
        attribute, where = match.group(1), html.unescape(match.group(2))
        if re.match(r"[a-z]+:", where):
            return match.group(0)
        path, _, anchor = where.partition("#")
        file = posixpath.normpath(posixpath.join(posixpath.dirname(page), path)) if path else page
        if file in self.known:
            self.wanted.append((page, file, anchor))
            new = (target(file) if path else "") + ("#" + anchor if anchor else "")
        elif (self.source / file).is_file() and file.rsplit(".")[-1] in ("png", "svg", "c", "h"):
            new = "files/" + file
            (self.folder / new).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.source / file, self.folder / new)
        elif (self.source / file).exists():
            return f'title="{html.escape(file)} in the sources"'
        else:
            self.faults.append(f"{page}: {where} leads nowhere")
            return match.group(0)
        return f'{attribute}="{html.escape(new)}"'

    def convert(self, page):
        text = re.sub(r"<!-- (file|run|before|page):.*?-->\n?", "",
                      (self.source / page).read_text(encoding="utf-8"))
        converter = markdown.Markdown(extensions=["tables", "fenced_code", "sane_lists", "toc"])
        body = converter.convert(text)
        # A bar within a cell of a table is written \| and the converter leaves it so in code.
        body = re.sub(r"<code>[^<]*</code>", lambda code: code.group(0).replace("\\|", "|"), body)
        self.anchors[page] = set(re.findall(r'\bid="([^"]+)"', body))
        return LINK.sub(lambda match: self.link(page, match), body)

    def write(self, page, body):
        title = re.search(r"<h1[^>]*>(.*?)</h1>", body)
        title = re.sub(r"<[^>]+>", "", title.group(1)) if title else page
        name = title if title == "Glint" else title + " - Glint"
        (self.folder / target(page)).write_text(
            f'<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            f'<meta name="viewport" content="width=device-width">\n<title>{name}</title>\n'
            f'<link rel="stylesheet" href="style.css">\n</head>\n<body>\n{self.menu(page)}\n'
            f"<main>\n{body}\n</main>\n</body>\n</html>\n", encoding="utf-8")

    def make(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        (self.folder / "style.css").write_text(STYLE.lstrip(), encoding="utf-8")
        self.wanted = []
        for _, page in self.pages:
            if page:
                self.write(page, self.convert(page))
        for page, file, anchor in self.wanted:
            if anchor and anchor not in self.anchors[file]:
                self.faults.append(f"{page}: there is no #{anchor} in {file}")
        for path in sorted((self.source / "docs").glob("*.md")):
            if f"docs/{path.name}" not in self.known:
                self.faults.append(f"docs/{path.name} is in no menu")
        return self.faults


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    site = Site(source, folder)
    for fault in site.make():
        print("site:", fault, file=sys.stderr)
    print(folder / "index.html")
    sys.exit(bool(site.faults))


main()
