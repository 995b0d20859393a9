"""Copies the documents for mdBook, and checks the pages that it makes of them (called by .ci/book)."""

import os
import posixpath
import re
import shutil
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LINK = re.compile(r"\]\(([^)\s]+)\)|(?:src|href)=\"([^\"]+)\"")


def targets(page, text):
    """Files of the project that a page links to, by their paths from its folder."""
    for found in LINK.finditer(text):
        link = urlsplit(found[1] or found[2])
        if link.scheme or not link.path:
            continue
        yield posixpath.normpath(posixpath.join(posixpath.dirname(page), unquote(link.path)))


def copy(into):
    """Pages of docs/SUMMARY.md where they are in the project, and the files that they link to."""
    summary = Path("docs/SUMMARY.md").read_text(encoding="utf-8")
    pages = list(targets("docs/SUMMARY.md", summary))
    listed = {page for page in pages if page.startswith("docs/")}
    written = {page.as_posix() for page in Path("docs").rglob("*.md")} - {"docs/SUMMARY.md"}
    if listed != written:
        sys.exit(f"docs/SUMMARY.md: listed or written alone: {sorted(listed ^ written)}")
    missing = []
    for page in pages:
        text = Path(page).read_text(encoding="utf-8")
        for target in targets(page, text):
            if not Path(target).exists():
                missing.append(f"{page}: {target}")
            elif target.endswith(".md") and target not in pages:
                missing.append(f"{page}: {target} is not in docs/SUMMARY.md")
            elif Path(target).is_file() and target not in pages:
                (into / target).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(target, into / target)
        # A folder has no page: its name stays, the link goes.
        text = re.sub(r"\[([^\]]*)\]\(([^)\s#]+)\)", lambda link: unlinked(page, link), text)
        copied = into / indexed(page)
        copied.parent.mkdir(parents=True, exist_ok=True)
        copied.write_text(LINK.sub(lambda link: indexed(link[0]), text), encoding="utf-8")
    if missing:
        sys.exit("\n".join(missing))
    # The list is at the root of the copy.
    moved = re.sub(r"\]\(([^)]+)\)", lambda link: f"]({posixpath.normpath('docs/' + link[1])})", summary)
    (into / "SUMMARY.md").write_text(indexed(moved), encoding="utf-8")
    print(f"{len(pages)} pages copied")


def indexed(path):
    """The name that mdBook gives to a README's page, and does not put into links to it."""
    return path.replace("README.md", "index.md")


def unlinked(page, link):
    """A link to a folder as its words."""
    folder = posixpath.join(posixpath.dirname(page), link[2])
    return link[1] if Path(folder).is_dir() else link[0]


class Page(HTMLParser):
    """Links and anchors of a page."""

    def __init__(self):
        super().__init__()
        self.links, self.anchors = [], set()

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.links.append(value)
            elif name in ("id", "name") and value:
                self.anchors.add(value)


def check(book):
    """Ends with 1 where a link of a page leads nowhere."""
    pages = {}
    for path in book.rglob("*.html"):
        page = Page()
        page.feed(path.read_text(encoding="utf-8"))
        pages[path.relative_to(book).as_posix()] = page
    dead, links = [], 0
    for name, page in sorted(pages.items()):
        if name in ("404.html", "print.html", "toc.html"):
            # All pages in one, and what mdBook adds: their links are those of the others.
            continue
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            links += 1
            target = name
            if parts.path:
                target = posixpath.normpath(posixpath.join(posixpath.dirname(name), unquote(parts.path)))
            anchor = unquote(parts.fragment)
            if not os.path.isfile(book / target):
                dead.append(f"{name}: {link}")
            elif anchor and target in pages and anchor not in pages[target].anchors:
                dead.append(f"{name}: no heading {link}")
    print(f"{len(pages)} pages, {links} links, {len(dead)} dead")
    if dead or not links:
        sys.exit("\n".join(dead) or "no links were found")


{"copy": copy, "check": check}[sys.argv[1]](Path(sys.argv[2]))
