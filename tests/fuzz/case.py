# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Defines a case: the files that one run of the program gets, and the command line. A case can be laid out in
a folder, and kept as one JSON file that --replay takes."""
from __future__ import annotations

import base64
import dataclasses
import hashlib
import json
import os
import pathlib
import struct
import zlib

# Stands in files and command lines for the absolute path of the folder that no case may touch.
OUTSIDE = "@OUTSIDE@"


class Raw:
    """A value that is written as it stands, whatever the surrounding format requires."""

    def __init__(self, text: str):
        self.text = text

    def __repr__(self):
        return f"Raw({self.text[:40]!r})"


def to_bytes(text: str) -> bytes:
    """Encodes text. Lone surrogates \\udc80 to \\udcff become the bytes 0x80 to 0xff, which makes text that
    is not UTF-8."""
    return text.encode(
        "utf-8", "surrogateescape" if all(not 0xD800 <= ord(c) < 0xDC80 for c in text) else "surrogatepass"
    )


def json_text(tree, indent=None) -> str:
    raws: list[str] = []

    def plain(value):
        if isinstance(value, Raw):
            raws.append(value.text)
            return f"@RAW{len(raws) - 1}@"
        if isinstance(value, dict):
            return {key: plain(item) for key, item in value.items()}
        if isinstance(value, list):
            return [plain(item) for item in value]
        return value

    text = json.dumps(plain(tree), ensure_ascii=False, indent=indent)
    for number, raw in enumerate(raws):
        text = text.replace(f'"@RAW{number}@"', raw, 1)
    return text


def yaml_text(tree, depth=0) -> str:
    """Writes maps as blocks with one key on each line, so that mutators of lines have lines to change. Lists
    of scalars take one line."""
    indent = "  " * depth
    if isinstance(tree, dict) and tree:
        lines = []
        for key, value in tree.items():
            nested = (isinstance(value, dict) and value) or (
                isinstance(value, list) and any(isinstance(v, dict) for v in value)
            )
            lines.append(
                f"{indent}{yaml_key(key)}:"
                + ("\n" + yaml_text(value, depth + 1) if nested else f" {json_text(value)}\n")
            )
        return "".join(lines)
    if isinstance(tree, list) and any(isinstance(value, dict) for value in tree):
        lines = []
        for value in tree:
            block = (
                yaml_text(value, depth + 1)
                if isinstance(value, dict) and value
                else f"{indent}  {json_text(value)}\n"
            )
            lines.append(f"{indent}- {block[len(indent) + 2:]}")
        return "".join(lines)
    return f"{indent}{json_text(tree)}\n"


def yaml_key(key: str) -> str:
    return key if key and all(c.isalnum() or c in "_-" for c in key) else json_text(key)


def glb_bytes(tree, binary: bytes) -> bytes:
    text = to_bytes(json_text(tree))
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def journal_bytes(lines: list) -> bytes:
    """Returns a journal as the program writes it: each line has its CRC-32."""
    text = b""
    for line in lines:
        body = to_bytes(
            line.text if isinstance(line, Raw) else json_text(line).replace(", ", ",").replace(": ", ":")
        )
        text += body + b"\t%08x\n" % zlib.crc32(body)
    return text


PACKERS = {
    "json": lambda entry: to_bytes(json_text(entry.tree)),
    "yaml": lambda entry: to_bytes(yaml_text(entry.tree)),
    "glb": lambda entry: glb_bytes(entry.tree, entry.data),
    "journal": lambda entry: journal_bytes(entry.tree if isinstance(entry.tree, list) else [entry.tree]),
}


@dataclasses.dataclass
class Entry:
    """Describes a file, or what stands in its place."""

    type: str = "file"  # file, folder, fifo, link (data holds the target), sparse (data holds the size)
    data: bytes = b""
    tree: object = None  # parsed content while it is known, from which `pack` makes bytes
    pack: str = ""

    def content(self) -> bytes:
        return PACKERS[self.pack](self) if self.pack else self.data

    def flatten(self) -> None:
        """Replaces the tree by its bytes."""
        self.data, self.tree, self.pack = self.content(), None, ""


@dataclasses.dataclass
class Case:
    kind: str
    command: list[str]
    files: dict[str, Entry]
    name: str = ""
    done: list[str] = dataclasses.field(default_factory=list)  # the changes in words
    env: dict[str, str] = dataclasses.field(default_factory=dict)
    exit: list[int] = dataclasses.field(default_factory=lambda: [0, 1])  # exit codes that are no fault
    keeps_files: bool = True  # the command only reads, so none of the files may change
    names_file: bool = True  # a message with exit code 1 must name one of the files
    secret: bool = True  # no content from outside the folder may be printed

    def lay_out(self, folder: pathlib.Path, outside: pathlib.Path) -> None:
        for name, entry in self.files.items():
            file = os.path.join(os.fsencode(folder), to_bytes(name))
            os.makedirs(os.path.dirname(file), exist_ok=True)
            if entry.type == "folder":
                os.makedirs(file, exist_ok=True)
            elif entry.type == "fifo":
                os.mkfifo(file)
            elif entry.type == "link":
                os.symlink(entry.data.replace(OUTSIDE.encode(), os.fsencode(outside)), file)
            else:
                with open(file, "wb") as out:
                    if entry.type == "sparse":
                        out.truncate(int(entry.data))
                    else:
                        out.write(entry.content().replace(OUTSIDE.encode(), os.fsencode(outside)))

    def to_json(self) -> str:
        files = {}
        for name, entry in self.files.items():
            content = entry.content() if entry.type == "file" else entry.data
            record: dict = {} if entry.type == "file" else {"type": entry.type}
            try:
                text = content.decode("utf-8")
                printable = len(text) < 4000 and all(c in "\n\t" or c.isprintable() for c in text)
            except UnicodeDecodeError:
                printable = False
            if printable:
                record["text"] = text.splitlines(keepends=True) if text.count("\n") > 1 else text
            else:
                record["zlib_base64"] = base64.b64encode(zlib.compress(content, 9)).decode()
            files[name.encode("utf-8", "surrogatepass").decode("latin-1")] = record
        fields = {
            field.name: getattr(self, field.name)
            for field in dataclasses.fields(self)
            if field.name != "files"
        }
        return json.dumps({**fields, "files": files}, indent=1) + "\n"

    @staticmethod
    def from_json(text: str) -> "Case":
        fields = json.loads(text)
        files = {}
        for name, record in fields.pop("files").items():
            if "text" in record:
                data = "".join(record["text"]).encode("utf-8")
            else:
                data = zlib.decompress(base64.b64decode(record["zlib_base64"]))
            files[name.encode("latin-1").decode("utf-8", "surrogatepass")] = Entry(
                record.get("type", "file"), data
            )
        return Case(files=files, **fields)

    def copy(self) -> "Case":
        """Returns a copy that shares its trees. A mutator therefore copies a tree before it changes it."""
        files = {name: dataclasses.replace(entry) for name, entry in self.files.items()}
        return dataclasses.replace(
            self, files=files, done=list(self.done), command=list(self.command), env=dict(self.env)
        )


def sign_manifest(case: Case, root: str) -> bool:
    """Gives every file in the manifest its real size and hash, so that `verify` looks further than the
    hashes. Returns whether the case has a manifest that could be signed."""
    entry = case.files.get(f"{root}/manifest.json")
    if entry is None or entry.type != "file":
        return False
    try:
        manifest = json.loads(entry.content())
        for file in manifest["files"]:
            listed = case.files.get(f"{root}/{file['path']}")
            if listed is not None and listed.type == "file":
                content = listed.content()
                file["size"], file["sha256"] = len(content), hashlib.sha256(content).hexdigest()
    except (ValueError, TypeError, KeyError, RecursionError):
        return False
    case.files[f"{root}/manifest.json"] = Entry(data=json.dumps(manifest, indent=1).encode())
    return True
