"""What a user has who installs the wheel: `python -m tests.release.from_wheel dist`, or `make dist-test`.

The wheel is installed into a new environment in a temporary folder, with nothing of the checkout in reach. Then the
demonstration runs, the service answers with its page, an experiment runs, and the files inside the package are read.
"""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bench
from tests.paths import ROOT

PACKAGES = ("bench", "compensator", "drivers", "sim_backend", "web")
LONGEST_S = 300.0  # of one step, on a busy machine
READ_FILES = """
from bench.config.configuration import PRESETS, preset_configuration
from bench.service.http.openapi import examples
from drivers.modbus.map_file import known_maps, load_map
for preset in PRESETS.iterdir(): preset_configuration(preset.name.removesuffix(".toml"))
for name in known_maps(): load_map(name)
assert examples() and known_maps()
import bench; print(bench.__file__)
"""


class Installed:
    """The wheel in an environment of its own.

    Args:
        folder: empty; the working directory of everything that runs.
        wheel: the file.
    """

    def __init__(self, folder: Path, wheel: Path) -> None:
        self._folder = folder
        self._bin = folder / "environment" / "bin"
        kept = {"PATH", "HOME", "LANG", "SSL_CERT_FILE", "REQUESTS_CA_BUNDLE"}
        self._environment = {name: value for name, value in os.environ.items() if name in kept or "PIP" in name}
        with step("install"):
            self._run(sys.executable, "-m", "venv", str(folder / "environment"))
            pinned = ("--constraint", str(ROOT / "constraints.txt"))
            self.run("pip", "install", "--quiet", "--disable-pip-version-check", *pinned, str(wheel))
        self._environment["HOME"] = str(folder)  # with nothing in it that an earlier run has compiled

    def run(self, program: str, *words: str) -> str:
        """What a program of the environment prints.

        Raises:
            SystemExit: it failed; with what it printed.
        """
        return self._run(str(self._bin / program), *words)

    def _run(self, *words: str) -> str:
        done = subprocess.run(
            words, cwd=self._folder, env=self._environment, capture_output=True, text=True, timeout=LONGEST_S
        )
        if done.returncode:
            raise SystemExit(f"{' '.join(words)}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    @contextmanager
    def service(self) -> Iterator[tuple[str, str]]:
        """A running service: its address, and the token that it printed."""
        words = [str(self._bin / "friction-bench"), "--store", "served.sqlite", "serve", "--port", str(_free_port())]
        process = subprocess.Popen(
            words, cwd=self._folder, env=self._environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        try:
            yield _address_and_token(process)
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(timeout=LONGEST_S)


def _free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


def _address_and_token(process: "subprocess.Popen[str]") -> tuple[str, str]:
    """What the service prints when it has started."""
    assert process.stdout is not None
    printed = ""
    for line in process.stdout:
        printed += line
        address = re.search(r"^page +(\S+)/$", printed, re.MULTILINE)
        token = re.search(r"^token +(\S+)", printed, re.MULTILINE)
        if address and token:
            return address[1], token[1]
    raise SystemExit(f"the service ended before it printed its address and its token:\n{printed}")


def ask(url: str, token: str = "", body: Any = None) -> bytes:
    """What a route answers."""
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(url, data, headers | {"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=LONGEST_S) as answer:
        found: bytes = answer.read()
    return found


@contextmanager
def step(name: str) -> Iterator[None]:
    """Print how long a step took."""
    begin_s = time.monotonic()
    yield
    print(f"{name:12} {time.monotonic() - begin_s:5.1f} s", flush=True)


def missing(wheel: Path) -> set[str]:
    """Files of the packages that the repository has and the wheel has not."""
    words = ["git", "-C", str(ROOT), "ls-files", *PACKAGES]
    listed = subprocess.run(words, capture_output=True, text=True, check=True).stdout.split()
    with zipfile.ZipFile(wheel) as packed:
        return set(listed) - set(packed.namelist())


def serve(installed: Installed) -> None:
    """The page with all that it loads, and an experiment from start to end."""
    with installed.service() as (url, token):
        page = ask(url).decode()
        for path in re.findall(r'(?:src|href)="(/[^"]+)"', page):
            assert ask(url + path), path
        assert ask(f"{url}/static/plotly.min.js")
        body = {"kind": "steps", "parameters": {"repeats": 1}, "pace": "fast"}
        number = json.loads(ask(f"{url}/api/v1/experiments", token, body))["experiment_id"]
        deadline_s = time.monotonic() + LONGEST_S
        while (found := json.loads(ask(f"{url}/api/v1/experiments/{number}")))["outcome"] == "running":
            assert time.monotonic() < deadline_s
            time.sleep(0.2)
        assert found["outcome"] == "completed", found


def main() -> None:
    """Try the one wheel of a folder."""
    [wheel] = Path(sys.argv[1]).resolve().glob("*.whl")
    assert not missing(wheel), f"not in the wheel: {', '.join(sorted(missing(wheel)))}"
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        installed = Installed(folder, wheel)
        assert installed.run("friction-bench", "--version") == f"friction-bench {bench.__version__}\n"
        with step("files"):
            assert str(folder.resolve()) in installed.run("python", "-c", READ_FILES)
        with step("demo"):
            installed.run("friction-bench", "demo", "--report", "demo.html")
            assert (folder / "demo.html").stat().st_size > 100_000
        with step("serve"):
            serve(installed)
    print(f"{wheel.name} works without the checkout")


if __name__ == "__main__":
    main()
