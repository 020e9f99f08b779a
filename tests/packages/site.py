#!/usr/bin/env python3
"""The guides as a site: mkdocs makes it without a warning, every link within it leads somewhere, nothing is loaded from
elsewhere.
    tests/packages/site.py ROOT SCRATCH
"""
import subprocess
import sys
import urllib.parse
from html.parser import HTMLParser
from pathlib import Path

LOADING = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src"}
OF_SEARCH_ENGINES = "canonical"  # links of this kind load nothing


class Page(HTMLParser):
    """What one page of the site holds: ids, links, and what a browser fetches to show it."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.links, self.loads = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.ids.update(values[key] for key in ("id", "name") if values.get(key))
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        if tag in LOADING and values.get(LOADING[tag]) and values.get("rel") != OF_SEARCH_ENGINES:
            self.loads.append(values[LOADING[tag]])


def main(root, site):
    subprocess.run(["mkdocs", "build", "--strict", "--clean", "--quiet", "--config-file", root / "mkdocs.yml",
                    "--site-dir", site], check=True)
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}
    faults = []
    for path, page in pages.items():
        faults += [f"{path.relative_to(site)} loads {url}" for url in page.loads if urllib.parse.urlparse(url).netloc]
        for url in page.links + page.loads:
            parts = urllib.parse.urlparse(url)
            if parts.scheme or parts.netloc or path.name == "404.html":  # whose links are from the site's root
                continue
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            known = pages.get(target)
            if not target.exists() or (parts.fragment and known and parts.fragment not in known.ids):
                faults.append(f"{path.relative_to(site)}: {url} leads nowhere")
    if len(pages) < 10:
        faults.append(f"only {len(pages)} pages were made")
    print("\n".join(faults), file=sys.stderr, end="")
    return 1 if faults else 0


sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()))
