# SPDX-License-Identifier: Apache-2.0
"""What Doxygen's XML lacks for pages by header: whole names of files, and what a file declares in its namespace."""

import copy
import pathlib
import xml.etree.ElementTree as xml_tree


def file_of(entry: xml_tree.Element) -> str:
    location = entry.find("location")
    assert location is not None
    return location.get("file", "")


def complete(xml: pathlib.Path) -> None:
    index = xml_tree.parse(xml / "index.xml")
    namespaces = []
    files = {}
    for entry in index.getroot().findall("compound"):
        path = xml / f"{entry.get('refid')}.xml"
        if entry.get("kind") == "namespace":
            namespaces.append(xml_tree.parse(path).getroot().find("compounddef"))
        elif entry.get("kind") == "file":
            tree = xml_tree.parse(path)
            compound = tree.getroot().find("compounddef")
            assert compound is not None
            name = entry.find("name")
            assert name is not None
            name.text = file_of(compound)  # there are two errors.hpp
            files[name.text] = path, tree, compound
    for path, tree, compound in files.values():
        described = compound.find("detaileddescription")
        assert described is not None
        place = list(compound).index(described)
        for namespace in namespaces:
            assert namespace is not None
            for section in namespace.findall("sectiondef"):
                members = [member for member in section.findall("memberdef") if file_of(member) == file_of(compound)]
                if members:
                    here = xml_tree.Element("sectiondef", kind=section.get("kind", ""))
                    here.extend(copy.deepcopy(member) for member in members)
                    compound.insert(place, here)
                    place += 1
        tree.write(path, encoding="utf-8", xml_declaration=True)
    index.write(xml / "index.xml", encoding="utf-8", xml_declaration=True)
