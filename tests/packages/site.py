#!/usr/bin/env python3
"""The guides as a site: mkdocs makes it without a warning, every link within it leads somewhere, nothing is loaded from
elsewhere, and it has the screenshots of the data for software centres.
    tests/packages/site.py ROOT SCRATCH
"""
import struct
import subprocess
import sys
import urllib.parse
import xml.etree.ElementTree
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


def screenshot_faults(metainfo, site):
    """What is wrong with the screenshots: pictures of the site, as large as it says, each of them once."""
    component = xml.etree.ElementTree.parse(metainfo)
    base = component.findtext("url[@type='homepage']") + "/"
    images = component.findall("screenshots/screenshot/image")
    faults = [] if images else ["there are no screenshots"]
    if len({image.text for image in images}) < len(images):
        faults.append("a screenshot is there twice")
    for image in images:
        file = site / image.text.removeprefix(base)
        if not image.text.startswith(base) or not file.is_file():
            faults.append(f"{image.text} is not on the site")
            continue
        size = struct.unpack(">II", file.read_bytes()[16:24])  # of a PNG's first chunk
        if size != (int(image.get("width")), int(image.get("height"))):
            faults.append(f"{image.text} has {size} pixels")
    return faults


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
    faults += screenshot_faults(root / "Assets/desktop/org.example.RayTracingTwins.metainfo.xml", site)
    if len(pages) < 10:
        faults.append(f"only {len(pages)} pages were made")
    print("\n".join(faults), file=sys.stderr, end="")
    return 1 if faults else 0


sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()))
