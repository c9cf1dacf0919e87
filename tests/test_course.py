"""Refreshing and copying notebooks."""

import errno
import os
import re
import shutil
import subprocess
import sys
import zipfile
from importlib import metadata
from pathlib import Path

import nbformat
import pytest

from hoverslam_lib import checks, course

ROOT = course.NOTEBOOKS.parent
FIGURE = """
import matplotlib.pyplot as plt
from hoverslam_lib import plotting
plotting.use_style()
fig, ax = plt.subplots()
ax.plot([0, 1], [0, 1], **plotting.line("rk4"))
plotting.show(fig, alt="a line to 1")
"""
FILM = """
from hoverslam_lib.animation import Animation
display(Animation(b"GIF", "a film of 1 s", (0.0,), (40,), 480), metadata={"isolated": True})
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A project with two small lessons, as an editor would leave them: not executed, with metadata of a machine."""
    notebooks = tmp_path / "notebooks"
    (notebooks / "solutions").mkdir(parents=True)
    (notebooks / "images").mkdir()
    (notebooks / "images" / "picture.png").write_bytes(b"png")
    for name in ("instructor_guide.md", "mission_control.ipynb", "glossary.md", "solutions/lesson_01.py"):
        (notebooks / name).write_text(name)
    (notebooks / ".hoverslam_progress.json").write_text("the instructor's own")
    for name in ("01_first", "02_second"):
        cells = [nbformat.v4.new_markdown_cell("# 1"), nbformat.v4.new_code_cell("print('a')\nprint('b')")]
        cells.append(nbformat.v4.new_code_cell(FIGURE, metadata={"collapsed": True, "tags": ["kept"]}))
        cells.append(nbformat.v4.new_code_cell(FILM))
        metadata = {"language_info": {"name": "python", "version": "3.2.1"}}
        nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata=metadata), notebooks / f"{name}.ipynb")
    monkeypatch.setattr(course, "NOTEBOOKS", notebooks)
    return notebooks


def test_refresh_executes_cleans_and_changes_nothing_the_second_time(folder, capfd):
    path = folder / "01_first.ipynb"
    assert course.problems(path) != []
    assert course.refresh(path) == []
    once = path.read_bytes()
    stored = nbformat.reads(once.decode(), as_version=4)
    assert [cell.execution_count for cell in stored.cells[1:]] == [1, 2, 3]
    assert stored.cells[1].outputs[0].text == "a\nb\n"
    assert stored.cells[2].metadata == {"tags": ["kept"]}
    assert b"3.2.1" not in once
    assert 'alt="a line to 1"' in stored.cells[2].outputs[0].data["text/html"]
    assert 'src="data:image/gif;base64,R0lG">' in stored.cells[3].outputs[0].data["text/html"]
    assert [cell.outputs[0].get("metadata", {}) for cell in stored.cells[1:]] == [{}, {}, {}]
    assert course.refresh(path) == []
    assert path.read_bytes() == once
    assert capfd.readouterr() == ("", ""), "neither the kernel nor who starts it has anything to say"


def test_refresh_of_a_lesson_that_raises_says_so_and_leaves_the_file(folder, capsys):
    path = folder / "02_second.ipynb"
    broken = nbformat.read(path, as_version=4)
    broken.cells.append(nbformat.v4.new_code_cell("1 / 0"))
    nbformat.write(broken, path)
    before = path.read_bytes()
    assert course.main(["refresh", "02"]) == 1
    assert path.read_bytes() == before
    assert "ZeroDivisionError" in capsys.readouterr().out


def test_refresh_picks_lessons_by_number_name_or_path(folder):
    shutil.copy(folder / "01_first.ipynb", folder / "12_twelfth.ipynb")
    assert [path.stem for path in course.lessons()] == ["01_first", "02_second", "12_twelfth", "mission_control"]
    for name in ("2", "02", "02_second", "sec", "Second", "notebooks/02_second.ipynb"):
        assert [path.stem for path in course.lessons([name])] == ["02_second"]
    assert [path.stem for path in course.lessons(["mission", "1"])] == ["mission_control", "01_first"]


@pytest.mark.parametrize("name", ["77", "0", "-1", "²", "", "third", "st", "my_course/02_second.ipynb"])
@pytest.mark.parametrize("command", [["refresh"], ["copy", "new", "--lesson"]])
def test_unknown_lesson_is_named_with_those_there_are(folder, tmp_path, monkeypatch, capsys, command, name):
    shutil.copy(folder / "01_first.ipynb", folder / "12_last.ipynb")
    monkeypatch.chdir(tmp_path)
    assert course.main([*command, name]) == 2
    message = capsys.readouterr().err
    assert repr(name) in message
    assert "01_first, " in message
    assert message.count("\n") == 1


@pytest.mark.parametrize("command", [["refresh"], ["copy", "new"], ["collect", "."]])
def test_where_there_are_no_notebooks_a_sentence_says_so(tmp_path, monkeypatch, capsys, command):
    monkeypatch.setattr(course, "NOTEBOOKS", tmp_path / "notebooks")
    (tmp_path / "one").mkdir()
    monkeypatch.chdir(tmp_path)
    assert course.main(command) == 2
    said = f"there are no notebooks in {tmp_path / 'notebooks'}: run this from a checkout of the course\n"
    assert capsys.readouterr() == ("", said)
    assert [path.name for path in tmp_path.iterdir()] == ["one"]


# ---- copies -------------------------------------------------------------------------------------------------------

STUDENTS = {".gitignore", "01_first.ipynb", "02_second.ipynb", "glossary.md", "images/picture.png"}


def tree(folder):
    """Everything in a folder: the names of the files, and what is in them."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def leave_behind(folder):
    """What others may have left between the lessons."""
    (folder / "images" / ".ipynb_checkpoints").mkdir()
    (folder / "images" / ".ipynb_checkpoints" / "picture-checkpoint.png").write_text("another's")
    for place in ("my_course", "erratum", ".ipynb_checkpoints"):
        (folder / place).mkdir()
        shutil.copy(folder / "01_first.ipynb", folder / place)
    for name in ("01_first-Copy1.ipynb", "Untitled.ipynb", "1_first.ipynb", "01_first.txt"):
        (folder / name).write_text("another's")


@pytest.mark.parametrize("options", [[], ["--for-teaching"]])
def test_copy_holds_what_is_meant_for_its_reader_and_nothing_that_others_left(folder, tmp_path, capsys, options):
    course.refresh(folder / "01_first.ipynb")
    leave_behind(folder)
    before = tree(folder)
    assert course.main(["copy", str(tmp_path / "mine"), *options]) == 0
    copied = tree(tmp_path / "mine")
    assert copied.keys() == STUDENTS | ({"instructor_guide.md", "mission_control.ipynb"} if options else set())
    assert copied[".gitignore"] == b"*\n"
    assert capsys.readouterr().out.count("wrote") == len(copied) - 1
    assert tree(folder) == before
    if options:
        assert {name: before[name] for name in copied if name != ".gitignore"}.items() <= copied.items()
        return
    stored, lesson = (nbformat.reads(text["01_first.ipynb"].decode(), as_version=4) for text in (before, copied))
    assert stored.cells[1].outputs != []
    for was, cell in zip(stored.cells, lesson.cells, strict=True):
        assert (cell.id, cell.source, cell.metadata) == (was.id, was.source, was.metadata)
        assert cell.get("outputs", []) == []
        assert cell.get("execution_count") is None


@pytest.mark.parametrize("options", [[], ["--for-teaching"]])
def test_second_run_goes_on_with_the_copy_that_is_there(folder, tmp_path, capsys, options):
    mine = tmp_path / "mine"
    command = ["copy", str(mine), *options]
    assert course.main(command) == 0
    for name in ("01_first.ipynb", "glossary.md", "notes.txt", ".gitignore"):
        (mine / name).write_text("my work")
    before = tree(mine)
    capsys.readouterr()
    assert course.main(command) == 0
    assert tree(mine) == before
    assert "left as it is" in capsys.readouterr().out
    (mine / "02_second.ipynb").unlink()
    assert course.main(command) == 0
    assert tree(mine) == before


def test_number_puts_a_fresh_lesson_beside_the_edited_one(folder, tmp_path):
    shutil.copy(folder / "01_first.ipynb", folder / "11_eleventh.ipynb")
    mine = tmp_path / "mine"
    assert course.main(["copy", str(mine), "--lesson", "1"]) == 0
    assert tree(mine).keys() == STUDENTS | {"11_eleventh.ipynb"}
    fresh = tree(mine)["01_first.ipynb"]
    (mine / "01_first.ipynb").write_text("my work")
    for n in (2, 3):
        before = tree(mine)
        assert course.copy(mine, lesson="01") == [mine / f"01_first_fresh_{n}.ipynb"]
        assert tree(mine) == before | {f"01_first_fresh_{n}.ipynb": fresh}


@pytest.mark.parametrize("start", ["", "notebooks", "elsewhere", "elsewhere/mine"])
@pytest.mark.parametrize("where", ["mine", "elsewhere/mine", "a new folder/in one"])
def test_copy_is_the_same_from_every_folder(folder, tmp_path, monkeypatch, start, where):
    (tmp_path / "elsewhere" / "mine").mkdir(parents=True)
    monkeypatch.chdir(tmp_path / start)
    assert course.main(["copy", os.path.relpath(tmp_path / where)]) == 0
    assert tree(tmp_path / where).keys() == STUDENTS
    assert len(tree(tmp_path)) == len(tree(folder)) + len(STUDENTS)


REFUSED = {
    "into the lessons": ("", "notebooks", "own folder"),
    "beside a lesson": ("", "notebooks/mine", "own folder"),
    "deep in the lessons": ("", "notebooks/images/mine/yours", "own folder"),
    "from inside the lessons": ("notebooks", "my_course", "own folder"),
    "here, in the lessons": ("notebooks", ".", "own folder"),
    "by a link to the lessons": ("", "link/mine", "own folder"),
    "among the tests": ("", "tests/mine", "own folder"),
    "into the course": ("", ".", "holds the course"),
    "into the course from below": ("notebooks", "..", "holds the course"),
    "above the course": ("notebooks", "../..", "holds the course"),
    "no name": ("", "", "holds the course"),
    "onto a file": ("", "file.txt", "is a file"),
    "onto a lesson": ("", "notebooks/01_first.ipynb", "is a file"),
    "below a file": ("", "file.txt/mine", "cannot use"),
    "onto a link to itself": ("", "loop", "cannot use"),
    "between files of another kind": ("", "other", "no copy"),
    "into another's checkout": ("", "checkout", "no copy"),
}


@pytest.mark.parametrize("case", REFUSED)
@pytest.mark.parametrize("options", [[], ["--for-teaching"], ["--lesson", "1"]])
def test_copy_where_it_would_do_harm_is_refused_with_a_sentence(folder, tmp_path, monkeypatch, capsys, case, options):
    start, where, why = REFUSED[case]
    for name in ("tests", "other", "checkout"):
        (tmp_path / name).mkdir()
    (tmp_path / "file.txt").write_text("mine")
    (tmp_path / "other" / "thesis.tex").write_text("mine")
    (tmp_path / "checkout" / ".gitignore").write_text("*.aux\n")
    try:
        (tmp_path / "link").symlink_to(folder, target_is_directory=True)
        (tmp_path / "loop").symlink_to(tmp_path / "loop")
    except OSError:  # Windows may not allow links
        if "link" in case:
            pytest.skip("no links on this system")
    monkeypatch.chdir(tmp_path / start)
    before, places = tree(tmp_path), sorted(tmp_path.rglob("*"))
    assert course.main(["copy", where, *options]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert re.fullmatch(rf".*{why}.* (name|choose) .*\n", said.err)
    assert tree(tmp_path) == before
    assert sorted(tmp_path.rglob("*")) == places


@pytest.mark.parametrize("call", ["mkdir", "write_text", "write_bytes", "rename"])
def test_what_the_file_system_refuses_is_a_sentence(folder, tmp_path, monkeypatch, capsys, call):
    """A read-only place, a full disk: as the superuser, who may write everywhere, would meet them too."""

    def refuse(path, *args, **kwargs):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))

    mine = tmp_path / "mine"
    monkeypatch.setattr(Path, call, refuse)
    assert course.main(["copy", str(mine)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert re.fullmatch(r"cannot use .*mine.*: Read-only file system; choose .*\n", said.err)
    assert not mine.exists() or tree(mine).keys() <= {".gitignore"}


def test_lesson_that_a_full_disk_cut_short_is_not_taken_for_the_student_s(folder, tmp_path, monkeypatch, capsys):
    def cut_short(path, content):
        with path.open("wb") as file:
            file.write(content[:100])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    mine = tmp_path / "mine"
    with monkeypatch.context() as full:
        full.setattr(Path, "write_bytes", cut_short)
        assert course.main(["copy", str(mine)]) == 2
    assert "No space left" in capsys.readouterr().err
    assert tree(mine).keys() == {".gitignore"}
    assert course.main(["copy", str(mine)]) == 0
    nbformat.read(mine / "01_first.ipynb", as_version=4)
    assert tree(mine).keys() == STUDENTS


@pytest.mark.skipif(not shutil.which("git"), reason="git is missing")
@pytest.mark.parametrize("for_teaching", [False, True])
def test_git_sees_nothing_of_a_copy_in_the_checkout(folder, tmp_path, for_teaching):
    def git(*words):
        return subprocess.run(["git", *words], cwd=tmp_path, check=True, capture_output=True, text=True).stdout

    git("init")
    before = git("status", "--porcelain")
    assert "notebooks" in before
    course.copy(tmp_path / "mine", for_teaching=for_teaching)
    for name in ("01_first.ipynb", "erratum.md", ".hoverslam_progress.json"):
        (tmp_path / "mine" / name).write_text("my work")
    assert git("status", "--porcelain") == before


def test_pytest_at_the_top_collects_no_copy(folder, tmp_path):
    for name in ("pyproject.toml", "conftest.py", "tests/nbval_sanitize.cfg"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    (folder / "mission_control.ipynb").unlink()
    course.copy(tmp_path / "my_course")
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-n", "0"]
    said = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True).stdout
    assert "notebooks/01_first.ipynb::Cell 0" in said
    assert "my_course" not in said


# ---- the course itself --------------------------------------------------------------------------------------------


@pytest.fixture(scope="module", params=[False, True], ids=["student", "teacher"])
def real(request, tmp_path_factory):
    """A copy of the course."""
    folder = tmp_path_factory.mktemp("copy") / "my_course"
    course.copy(folder, for_teaching=request.param)
    return folder


def test_every_link_in_a_copy_leads_somewhere_in_it(real):
    found = 0
    for path in sorted([*real.glob("*.ipynb"), *real.glob("*.md")]):
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".ipynb":
            text = "\n\n".join(c.source for c in nbformat.reads(text, as_version=4).cells if c.cell_type == "markdown")
        links = re.findall(
            r"""\]\(\s*<?([^)\s>]+)|\b(?:src|href)=["']([^"']+)|^\[[^]]+\]:\s*(\S+)""", text, re.MULTILINE
        )
        for link in filter(None, (link for kinds in links for link in kinds)):
            if not re.match(r"https?:|mailto:|data:|#", link):
                found += 1
                target = (real / link.partition("#")[0]).resolve()
                assert target.exists(), (path.name, link)
                assert target.is_relative_to(real.resolve()), (path.name, link)
    assert found > 30


def test_students_copy_has_every_lesson_as_stored_but_for_its_outputs(real):
    teaching = (real / "instructor_guide.md").exists()
    for path in course.lessons():
        copied = real / path.name
        assert copied.exists() == (teaching or path.name[0].isdigit())
        if copied.exists():
            stored, lesson = (nbformat.read(file, as_version=4).cells for file in (path, copied))
            assert [cell.source for cell in lesson] == [cell.source for cell in stored]
            assert all(cell.outputs == [] for cell in lesson if cell.cell_type == "code") != teaching


README = (ROOT / "README.md").read_text(encoding="utf-8")
COPIES = re.findall(r"python -m hoverslam_lib\.course (copy .+?)(?: && (\S+)jupyter lab (\S+))?$", README, re.MULTILINE)


def test_readme_makes_copies_and_opens_them():
    assert [words for words, _, _ in COPIES] == [
        "copy my_course",
        "copy my_course",
        "copy my_course --lesson 9",
        "copy my_class --for-teaching",
        "copy my_course --zip",
    ]
    (_, unix, opened), (_, windows, opened_there) = COPIES[:2]
    assert (unix, opened) == (".venv/bin/", "my_course/00_start_here.ipynb")
    assert (windows, opened_there) == (unix.replace("bin", "Scripts").replace("/", "\\"), opened.replace("/", "\\"))
    first = re.search(r"```sh\n(.*)\n```", README).group(1)
    assert first.endswith(f"copy my_course && .venv/bin/jupyter lab {opened}")


def test_readme_s_first_command_twice_makes_the_copy_and_goes_on_with_it(tmp_path):
    words, _, opened = COPIES[0]
    command = [sys.executable, "-m", "hoverslam_lib.course", *words.split()]
    encoding = os.environ | {"PYTHONIOENCODING": "ascii"}
    place = tmp_path / "añejo"
    place.mkdir()
    assert subprocess.run(command, cwd=place, env=encoding).returncode == 0
    (place / opened).write_text("my work")
    assert subprocess.run([*command[:-1], str(place / command[-1])], cwd=tmp_path, env=encoding).returncode == 0
    assert (place / opened).read_text() == "my work"
    teach = re.findall(r"(?:lab|voila) (my_class/\S+)", README)
    assert teach
    course.copy(place / "my_class", for_teaching=True)
    assert [name for name in teach if not (place / name).exists()] == []


# ---- one file to hand out -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module", params=[[], ["--for-teaching"], ["--withhold-solutions"]], ids=" ".join)
def handed_out(request, tmp_path_factory):
    """A copy in one file, made with some options, and the folder in which it was unpacked."""
    place = tmp_path_factory.mktemp("handed out")
    assert course.main(["copy", str(place / "my class"), "--zip", *request.param]) == 0
    assert [path.name for path in place.iterdir()] == ["my class.zip"]
    shutil.unpack_archive(place / "my class.zip", place / "unpacked")
    return request.param, place / "my class.zip", place / "unpacked" / "my class"


def test_file_holds_a_copy_and_what_pip_needs_and_nothing_else(handed_out, tmp_path):
    options, _, unpacked = handed_out
    assert course.main(["copy", str(tmp_path / "mine"), *options]) == 0
    found, copied = tree(unpacked), tree(tmp_path / "mine")
    assert copied.items() <= found.items()
    listed = subprocess.run(["git", "ls-files", "hoverslam_lib", "data"], cwd=ROOT, capture_output=True, text=True)
    library = {*listed.stdout.split(), "environment.txt", "pyproject.toml", "LICENSE"}
    assert {name: found[name] for name in library} == {name: (ROOT / name).read_bytes() for name in library}
    assert found.keys() == copied.keys() | library | {"README.md"}


def test_file_is_the_same_every_time(handed_out, tmp_path, monkeypatch):
    options, file, _ = handed_out
    monkeypatch.chdir(tmp_path)
    assert course.main(["copy", "new/my class.zip", "--zip", *options]) == 0
    assert (tmp_path / "new" / "my class.zip").read_bytes() == file.read_bytes()
    with zipfile.ZipFile(file) as packed:
        assert {member.date_time for member in packed.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_exercise_answers_in_the_unpacked_folder_by_the_library_that_is_in_it(handed_out):
    _, _, unpacked = handed_out
    code = "from hoverslam_lib import checks, data; data.load('constants'); print(checks.__file__)"
    code += "; print(checks.metres_per_second(lambda kmh: kmh / 3.6))"
    command = [sys.executable, "-X", "utf8", "-c", code]
    said = subprocess.run(command, cwd=unpacked, capture_output=True, text=True, encoding="utf-8").stdout
    assert Path(said.splitlines()[0]).is_relative_to(unpacked)
    assert "✔" in said


def test_file_s_readme_opens_what_is_there(handed_out):
    _, _, unpacked = handed_out
    readme = (unpacked / "README.md").read_text(encoding="utf-8")
    assert readme.startswith("# Landing a booster")
    unix, windows = (
        re.search(r"^(python3 .*)$", readme, re.MULTILINE).group(1),
        re.search(r"`(py .*)`", readme).group(1),
    )
    assert windows == unix.replace("python3", "py").replace("/bin/", "/Scripts/").replace("/", "\\")
    install, opened = re.search(r"install -r (\S+) && \S+jupyter lab (\S+)$", unix).groups()
    assert (unpacked / install).exists()
    assert (unpacked / opened).exists()
    assert "hoverslam_lib.course" not in readme, "there are no lessons to copy from"


@pytest.mark.parametrize("options", [["--zip"], ["--zip", "--for-teaching"], ["--zip", "--lesson", "1"]])
def test_file_that_is_there_is_left_as_it_is(tmp_path, capsys, options):
    (tmp_path / "mine.zip").write_text("my work")
    assert course.main(["copy", str(tmp_path / "mine"), *options]) == 2
    assert re.fullmatch(r".*(name another|choose one of them)\n", capsys.readouterr().err)
    assert tree(tmp_path) == {"mine.zip": b"my work"}


@pytest.mark.parametrize("where", ["notebooks/mine", "tests/mine"])
def test_file_among_the_course_s_own_is_refused(capsys, where):
    assert course.main(["copy", str(ROOT / where), "--zip"]) == 2
    assert "own folder" in capsys.readouterr().err
    assert not (ROOT / f"{where}.zip").exists()


# ---- pages --------------------------------------------------------------------------------------------------------


def test_copy_that_withholds_solutions_says_to_ask_the_instructor(folder, tmp_path, monkeypatch, capsys):
    copied = tmp_path / "copy"
    monkeypatch.chdir(tmp_path)
    assert course.main(["copy", "copy"]) == 0
    monkeypatch.chdir(copied)
    assert "def my_energy_factor" in repr(checks.show_solution("2.1"))
    monkeypatch.chdir(tmp_path)
    assert course.main(["copy", "copy", "--withhold-solutions"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f"wrote {Path('copy') / checks.WITHHELD}"
    monkeypatch.chdir(copied)
    assert repr(checks.show_solution("2.1")) == "The solution to exercise 2.1 is withheld here: ask your instructor."


def test_what_is_installed_is_held_against_the_list_and_how_to_mend_it_is_said(tmp_path, monkeypatch):
    assert course.environment_problems() == []
    monkeypatch.setattr(course, "NOTEBOOKS", tmp_path / "notebooks")
    assert course.environment_problems()[0].endswith("install the library from a checkout of the course")
    listed = ["# why", "numpy>=1.0,<2", "scipy>=1.15,<3", "pytest>=99.1,<100", "no-such-thing>=1,<2", "-e .", ""]
    (tmp_path / "environment.txt").write_text("\n".join(listed))
    newer, older, missing, mend = course.environment_problems()
    assert newer == f"numpy {metadata.version('numpy')} is installed; the course needs at least 1.0 and less than 2"
    assert older == f"pytest {pytest.__version__} is installed; the course needs at least 99.1 and less than 100"
    assert missing == "no-such-thing is missing"
    assert mend.startswith(f"To mend this, run in {tmp_path}: ")
    assert mend.endswith(" -m pip install -r environment.txt")
