"""What can be said of the container and the manifest without a container engine or a cluster."""

from __future__ import annotations

import os
import re
import tomllib
from ipaddress import ip_network
from typing import Any

import pytest
import yaml
from sqlalchemy import make_url

from onpath.app.classroom.class_opening import KEY, given_keys
from onpath.app.cli.serve import Serve
from onpath.app.storage.database_url import DATABASE
from onpath.app.viser_adapter.connection_limits import Proxies
from onpath.app.viser_adapter.request_filter import HEALTH
from tests.support.checkout import ROOT

DEPLOY = ROOT / "assets" / "deploy"
NGINX = (DEPLOY / "nginx.conf").read_text()
CONTAINERFILE = (ROOT / "Containerfile").read_text()


@pytest.fixture(scope="module")
def manifest() -> dict[str, Any]:
    documents = list(yaml.safe_load_all((DEPLOY / "onpath.yaml").read_text()))
    found = {document["kind"]: document for document in documents}
    assert len(found) == len(documents)
    return found


@pytest.fixture(scope="module")
def container(manifest: dict[str, Any]) -> dict[str, Any]:
    (container,) = manifest["Deployment"]["spec"]["template"]["spec"]["containers"]
    return container


def options() -> set[str]:
    """Of the command line."""
    return {"--" + name.replace("_", "-") for name in Serve.__dataclass_fields__}


def test_the_parts_of_the_manifest_find_each_other(
    manifest: dict[str, Any], container: dict[str, Any]
) -> None:
    deployment, service = manifest["Deployment"]["spec"], manifest["Service"]["spec"]
    labels = deployment["template"]["metadata"]["labels"]
    assert deployment["selector"]["matchLabels"] == service["selector"] == labels
    (port,) = service["ports"]
    assert port["targetPort"] in {each["name"] for each in container["ports"]}
    (rule,) = manifest["Ingress"]["spec"]["rules"]
    (path,) = rule["http"]["paths"]
    backend = path["backend"]["service"]
    assert backend["name"] == manifest["Service"]["metadata"]["name"]
    assert backend["port"]["name"] == port["name"]
    assert [rule["host"]] == manifest["Ingress"]["spec"]["tls"][0]["hosts"]
    assert f"https://{rule['host']}" in container["args"]
    mounted = {mount["name"] for mount in container["volumeMounts"]}
    assert mounted == {v["name"] for v in deployment["template"]["spec"]["volumes"]}


def test_the_pod_starts_an_existing_command_with_few_rights(
    manifest: dict[str, Any], container: dict[str, Any]
) -> None:
    assert {word for word in container["args"] if word.startswith("--")} <= options()
    assert {variable["name"] for variable in container["env"]} == {DATABASE, KEY}
    assert all("secretKeyRef" in variable["valueFrom"] for variable in container["env"])
    assert not any("--database" in word or "$(" in word for word in container["args"])
    for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
        assert container[probe]["httpGet"]["path"] == HEALTH
    pod = manifest["Deployment"]["spec"]["template"]["spec"]
    assert pod["securityContext"]["runAsNonRoot"] is True
    assert container["securityContext"]["readOnlyRootFilesystem"] is True
    assert not container["securityContext"]["allowPrivilegeEscalation"]


def test_trusted_proxies_pass_on_the_client_address(container: dict[str, Any]) -> None:
    assert re.search(r"^\s+proxy_set_header X-Forwarded-For \$remote_addr;$", NGINX, re.MULTILINE)
    networks = container["args"][container["args"].index("--trusted-proxy") + 1]
    pod = str(next(ip_network(networks).hosts()))
    assert Proxies((networks,)).client_address(pod, ["203.0.113.7"]) == "203.0.113.7"


def test_an_address_stays_with_its_pod_and_websockets_stay_open(manifest: dict[str, Any]) -> None:
    notes = manifest["Ingress"]["metadata"]["annotations"]
    prefix = "nginx.ingress.kubernetes.io/"
    assert all(isinstance(value, str) for value in notes.values())
    assert notes[prefix + "upstream-hash-by"] == "$uri"  # without the query
    assert all(int(notes[f"{prefix}proxy-{way}-timeout"]) > 60 for way in ("read", "send"))
    assert "sessionAffinity" not in manifest["Service"]["spec"]


def test_the_container_has_no_root_a_health_check_and_its_dependencies(
    container: dict[str, Any], manifest: dict[str, Any]
) -> None:
    (user,) = re.findall(r"^USER (\d+)$", CONTAINERFILE, re.MULTILINE)
    pod = manifest["Deployment"]["spec"]["template"]["spec"]
    assert int(user) == pod["securityContext"]["runAsUser"] > 0
    (port,) = re.findall(r"^EXPOSE (\d+)$", CONTAINERFILE, re.MULTILINE)
    assert int(port) == container["ports"][0]["containerPort"]
    assert f":{port}{HEALTH}" in CONTAINERFILE and f'"--port", "{port}"' in CONTAINERFILE
    (entry,) = re.findall(r"^ENTRYPOINT \[(.*)\]$", CONTAINERFILE, re.MULTILINE)
    assert set(re.findall(r"--[a-z-]+", entry)) <= options()
    (base, again) = re.findall(r"^FROM \S+python:([\d.]+)-slim", CONTAINERFILE, re.MULTILINE)
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())
    project, tools = settings["project"], settings["tool"]
    assert base == again and f">={base}" == project["requires-python"]
    (extras,) = re.findall(r"/src\[([\w,]+)\]", CONTAINERFILE)
    assert set(extras.split(",")) <= set(project["optional-dependencies"])
    packed = tools["hatch"]["build"]["targets"]["wheel"]["only-include"]
    for needed in ("pyproject.toml", "README.md", "LICENSE", *packed):
        assert f"!{needed}" in (ROOT / ".containerignore").read_text().splitlines()


def test_the_commands_of_the_administrators_page_exist(monkeypatch: pytest.MonkeyPatch) -> None:
    text = (DEPLOY / "README.md").read_text()
    commands = re.findall(r"onpath((?: --[a-z-]+(?: [\w./:]+)?)+)", text)
    assert commands and {word for c in commands for word in re.findall("--[a-z-]+", c)} <= options()
    (url,) = re.findall(rf"{DATABASE}=(postgresql\S+)$", text, re.MULTILINE)
    assert make_url(url).get_backend_name() == "postgresql"
    (keys,) = re.findall(rf"{KEY}=(.+)$", text, re.MULTILINE)
    monkeypatch.setenv(KEY, keys)
    assert len(given_keys()) == 2 and KEY not in os.environ
    for name in re.findall(r"\]\(([\w.]+)\)", text):
        assert (DEPLOY / name).is_file()


def test_the_unit_runs_what_nginx_expects_and_starts_it_again() -> None:
    unit = (DEPLOY / "onpath@.service").read_text()
    (command,) = re.findall(r"^ExecStart=\S+/onpath (.+)$", unit, re.MULTILINE)
    assert set(re.findall(r"--[a-z-]+", command)) <= options() and "--port %i" in command
    assert "Restart=on-failure" in unit.splitlines()
    ports = re.findall(r"server 127\.0\.0\.1:(\d+)", NGINX)
    assert [f"onpath@{port}" for port in ports] == re.findall(r"--now (.+)$", unit, re.M)[0].split()
    (origin,) = re.findall(r"--origin (\S+)", command)
    assert f'"{origin}"' in NGINX and f"server_name {origin.removeprefix('https://')};" in NGINX
