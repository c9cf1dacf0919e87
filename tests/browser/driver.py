"""JupyterLab or Voilà in a headless Chromium, as the tests and the benchmark drive them."""

import contextlib
import json
import os
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
JUPYTER = ["--allow-root", "--ServerApp.root_dir=."]
TOKEN = "a-token-for-the-tests"
# no notices over the page, and nothing saved but on command; all else is as users have it
SETTINGS = {
    "@jupyterlab/apputils-extension:notification": {"fetchNews": "false", "checkForUpdates": False},
    "@jupyterlab/docmanager-extension:plugin": {"autosave": False},
}
IDLE = """() => {
    const session = window.jupyterapp?.shell.currentWidget?.sessionContext?.session;
    return session?.kernel?.connectionStatus === 'connected' && session.kernel.status === 'idle';
}"""
SAVE = "async () => await window.jupyterapp.commands.execute('docmanager:save')"
CLOSE = """async () => {
    const notebook = window.jupyterapp.shell.currentWidget;
    await notebook.sessionContext.shutdown();
    notebook.dispose();
}"""
OUTPUTS = """() => {
    const cells = window.jupyterapp.shell.currentWidget.content.model.cells;
    const found = {errors: [], cells: 0, run: 0};
    for (const cell of cells) {
        if (cell.type !== 'code') continue;
        found.cells += 1;
        found.run += cell.executionCount !== null;
        for (let i = 0; i < cell.outputs.length; i++) {
            const output = cell.outputs.get(i);
            if (output.type === 'error') found.errors.push(output.toJSON().evalue);
        }
    }
    return found;
}"""


class Address(str):
    """Of a server, with the number of its process."""

    def __new__(cls, text, process):
        made = super().__new__(cls, text)
        made.process = process
        return made


class NoBrowser(Exception):
    """There is no Chromium to drive."""


@contextlib.contextmanager
def browser():
    """A Chromium: the system's, or else the one that ``playwright install chromium`` brings."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        path = CHROMIUM or playwright.chromium.executable_path
        if not Path(path).exists():
            raise NoBrowser("a Chromium is missing: playwright install chromium")
        chromium = playwright.chromium.launch(executable_path=path, args=FLAGS)
        try:
            yield chromium
        finally:
            chromium.close()


@contextlib.contextmanager
def server(application, folder, config):
    """JupyterLab ("lab"), Notebook 7 ("notebook") or Voilà ("voila") on a folder of notebooks; yields its address.

    Each has a configuration of its own; Voilà reads the folder's as well.
    """
    config = Path(config)
    (config / "labconfig").mkdir(parents=True, exist_ok=True)
    (config / "labconfig" / "default_setting_overrides.json").write_text(json.dumps(SETTINGS))
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    commands = {
        "lab": ["jupyterlab", *JUPYTER, "--LabApp.expose_app_in_browser=True"],
        "notebook": ["notebook", *JUPYTER, "--JupyterNotebookApp.expose_app_in_browser=True"],
        "voila": ["voila", "--Voila.ip=127.0.0.1", "."],
    }
    here = {"JUPYTER_CONFIG_DIR": config, "JUPYTERLAB_SETTINGS_DIR": config / "s", "JUPYTERLAB_WORKSPACES_DIR": config}
    command = [sys.executable, "-m", *commands[application], "--no-browser", f"--port={port}"]
    command.append(f"--IdentityProvider.token={TOKEN}")
    with open(config / "log.txt", "w") as log:
        running = subprocess.Popen(
            command, cwd=folder, env=os.environ | {k: str(v) for k, v in here.items()}, stdout=log, stderr=log
        )
    try:
        for _ in range(240):
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
                break
            time.sleep(0.25)
        yield Address(f"http://127.0.0.1:{port}", running.pid)
    finally:
        running.terminate()
        running.wait(30)


def open_voila(page, address, name):
    """Open a notebook as a page without code, and wait for its controls."""
    page.goto(f"{address}/voila/render/{name}?token={TOKEN}", timeout=90_000)
    page.wait_for_selector(".noUi-handle", timeout=60_000)


def open_alone(page, address, name):
    """Open a notebook in Notebook 7, and wait for its kernel."""
    page.goto(f"{address}/notebooks/{name}?token={TOKEN}", timeout=90_000)
    page.wait_for_function(IDLE, timeout=60_000)


def open_lab(page, address):
    """Load JupyterLab, with nothing open."""
    page.goto(f"{address}/lab?token={TOKEN}&reset", timeout=90_000)
    page.wait_for_function("() => window.jupyterapp?.commands.hasCommand('docmanager:open')", timeout=60_000)
    page.evaluate("async () => { await window.jupyterapp.restored; }")
    page.evaluate("() => window.jupyterapp.commands.execute('application:toggle-left-area')")


def open_notebook(page, name):
    """Open a notebook and wait for its kernel."""
    page.evaluate("async path => void (await window.jupyterapp.commands.execute('docmanager:open', {path}))", name)
    page.wait_for_selector(".jp-Notebook .jp-Cell", timeout=60_000)
    page.wait_for_function(IDLE, timeout=60_000)


def save_notebook(page):
    """Save the notebook with its outputs."""
    page.evaluate(SAVE)


def close_notebook(page):
    """End the kernel and close the notebook, without saving it."""
    page.evaluate(CLOSE)


def run_all(page, timeout=180):
    """Run every cell; returns {"errors": messages, "cells": how many, "run": how many of them}."""
    page.evaluate("() => window.jupyterapp.commands.execute('notebook:run-all-cells')")
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        page.wait_for_function(IDLE, timeout=timeout * 1000)
        found = page.evaluate(OUTPUTS)
        if found["run"] == found["cells"] or found["errors"]:
            return found
        time.sleep(0.2)
    return page.evaluate(OUTPUTS)
