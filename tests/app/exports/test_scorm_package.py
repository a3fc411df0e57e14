"""A SCORM package as a file: its manifest, and what is in it. Browser tests see it run."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree
from zipfile import ZipFile

import pytest

from onpath.app.cli.main import run_command
from onpath.app.common.templates import render
from onpath.app.exports.site.pages import Version
from onpath.app.exports.site.scorm_package import MANIFEST, TEMPLATES
from onpath.app.server.built_in_course import built_in_course
from tests.support.concept_key import asked_in, found_in, key_of
from tests.support.site_export import LESSON

PARTS = {
    "1.2": "{http://www.imsproject.org/xsd/imscp_rootv1p1p2}",
    "2004": "{http://www.imsglobal.org/xsd/imscp_v1p1}",
}
VENDOR = Path(__file__).parents[2] / "vendor" / "scorm-schemas"
SCHEMAS = {
    "1.2": {
        PARTS["1.2"]: "imscp_rootv1p1p2",
        "{http://www.adlnet.org/xsd/adlcp_rootv1p2}": "adlcp_rootv1p2",
    },
    "2004": {
        PARTS["2004"]: "imscp_v1p1",
        "{http://www.adlnet.org/xsd/adlcp_v1p3}": "adlcp_v1p3",
        "{http://www.imsglobal.org/xsd/imsss}": "imsss_v1p0",
    },
}
KIND = {
    "1.2": "{http://www.adlnet.org/xsd/adlcp_rootv1p2}scormtype",
    "2004": "{http://www.adlnet.org/xsd/adlcp_v1p3}scormType",
}


@pytest.mark.thorough
@pytest.mark.parametrize("version", ["1.2", "2004"])
def test_the_manifest_names_every_file_and_the_page(tmp_path: Path, version: Version) -> None:
    file, part = tmp_path / "lesson.zip", PARTS[version]
    command = ["export", "lesson", LESSON, "--scorm", str(file), "--version", version]
    assert run_command([*command, "--language", "de"]) == 0
    package = ZipFile(file)
    manifest = ElementTree.fromstring(package.read(MANIFEST))
    assert manifest.tag == f"{part}manifest"
    order = [each.tag for each in manifest]  # as the schema has it
    assert order == [f"{part}{name}" for name in ("metadata", "organizations", "resources")]
    (resource,) = manifest.iter(f"{part}resource")
    files = [each.get("href") for each in resource]
    assert sorted(package.namelist()) == sorted([MANIFEST, *map(str, files)])
    assert resource.get(KIND[version]) == "sco" and resource.get("href") in files
    (item,) = manifest.iter(f"{part}item")
    assert item.get("identifierref") == resource.get("identifier")
    (organization,) = manifest.iter(f"{part}organization")
    (organizations,) = manifest.iter(f"{part}organizations")
    assert organizations.get("default") == organization.get("identifier")
    forms = built_in_course().forms("de")
    for name in package.namelist():
        text = package.read(name).decode("utf-8", "replace")
        assert found_in([*key_of(forms), *asked_in(forms)], text) == [], name
    page = package.read(str(resource.get("href"))).decode()
    assert f'"scorm":{{"version":"{version}","partial":false}}' in page and "index.html" not in page
    again = tmp_path / "again.zip"
    assert run_command([*command[:4], str(again), *command[5:], "--language", "de"]) == 0
    assert again.read_bytes() == file.read_bytes()


@pytest.mark.parametrize("version", ["1.2", "2004"])
def test_the_manifest_is_valid_by_the_schemas_of_scorm(version: Version) -> None:
    """And a wrong one is not, so that the schemas are seen to be used."""
    xmlschema = pytest.importorskip("xmlschema")
    imports = "".join(
        f'<xs:import namespace="{name[1:-1]}" schemaLocation="{file}.xsd"/>'
        for name, file in SCHEMAS[version].items()
    )
    driver = f'<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema">{imports}</xs:schema>'
    schema = xmlschema.XMLSchema10(driver, base_url=str(VENDOR / version), allow="local")
    given = {"identifier": "onpath-a-en", "title": "a", "page": "a.html", "files": ["a.html"]}
    manifest = render(f"scorm/{TEMPLATES[version]}", **given)
    assert [each.reason for each in schema.iter_errors(manifest)] == []
    for right, wrong in (("<resources>", "<sources/><resources>"), (' href="a.html"/>', "/>")):
        assert not schema.is_valid(manifest.replace(right, wrong)), wrong


@pytest.mark.parametrize("template", TEMPLATES.values())
def test_titles_are_texts(template: str) -> None:
    title = '<Bahn> & "Uhr"'
    text = render(f"scorm/{template}", identifier="a", title=title, page="a.html", files=["a&b"])
    found = ElementTree.fromstring(text)
    assert title in [each.text for each in found.iter()]


@pytest.mark.thorough
def test_what_cannot_be_packed_is_refused_in_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = str(tmp_path / "a.zip")
    wrong = [
        (["01-path", "--scorm", target], LESSON),
        ([LESSON, "--scorm", target, "--language", "xx"], "en"),
        ([LESSON, "--scorm", str(tmp_path / "no" / "a.zip")], "no"),
    ]
    for arguments, hint in wrong:
        assert run_command(["export", "lesson", *arguments]) == 2, arguments
        said = capsys.readouterr().err
        assert said.count("\n") == 1 and hint in said and not list(tmp_path.iterdir())
