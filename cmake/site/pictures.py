"""A hook of mkdocs: pictures of the guide's notebooks, which ./build.sh guide makes in build/guide, stand where its
pages say <!-- picture NAME: caption -->. Where they were not made a line says what would be there."""

import pathlib
import re

from mkdocs.structure.files import File

MARK = re.compile(r"<!-- picture ([\w.-]+): (.*?) -->")


def folder_of(config):
    return pathlib.Path(config["config_file_path"]).parent / "build"


def on_files(files, config):
    for picture in sorted((folder_of(config) / "guide").glob("*.*")):
        files.append(File(f"guide/{picture.name}", str(folder_of(config)), config["site_dir"], False))
    return files


def on_page_markdown(markdown, config, files, **_):
    def shown(mark):
        name, caption = mark.groups()
        if files.get_file_from_path(f"guide/{name}") is None:
            return f"*A picture that `./build.sh guide` makes: {caption}.*"
        return f"![{caption}]({name})\n\n*{caption}*"

    return MARK.sub(shown, markdown)
