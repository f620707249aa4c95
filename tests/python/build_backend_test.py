"""What pip calls, with the build of this tree in place of a new one."""
import csv
import hashlib
import base64
import io
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

import percale


@pytest.fixture
def backend(source_dir, monkeypatch):
    monkeypatch.syspath_prepend(str(source_dir / 'scenes' / 'python' / 'wheel'))
    monkeypatch.delitem(sys.modules, 'build_backend', raising=False)
    import build_backend
    monkeypatch.setattr(build_backend, 'build_package', lambda settings: Path(percale.__file__).parent)
    return build_backend


def test_a_wheel_holds_the_package_and_a_record_that_is_true(backend, tmp_path):
    name = backend.build_wheel(tmp_path)
    assert name.startswith(f'percale-{percale.__version__}-cp3') and name.endswith('.whl')
    with zipfile.ZipFile(tmp_path / name) as wheel:
        files = {info.filename: wheel.read(info) for info in wheel.infolist()}
    info = f'percale-{percale.__version__}.dist-info'
    for row in csv.reader(files[f'{info}/RECORD'].decode().splitlines()):
        if row[0] == f'{info}/RECORD':
            continue
        digest = base64.urlsafe_b64encode(hashlib.sha256(files[row[0]]).digest()).rstrip(b'=').decode()
        assert row[1:] == [f'sha256={digest}', str(len(files[row[0]]))]
    assert {'percale/__init__.py', 'percale/__init__.pyi', 'percale/py.typed', f'{info}/LICENSE', f'{info}/WHEEL'} <= set(files)
    assert len([file for file in files if file.startswith('percale/')]) == 4  # those and the extension: no bytecode
    metadata = files[f'{info}/METADATA'].decode()
    assert f'Version: {percale.__version__}\n' in metadata and 'Requires-Dist: numpy\n' in metadata


def test_metadata_are_those_of_the_wheel_and_need_no_build(backend, tmp_path, monkeypatch):
    with zipfile.ZipFile(tmp_path / backend.build_wheel(tmp_path)) as wheel:
        files = {info.filename: wheel.read(info) for info in wheel.infolist()}
    monkeypatch.setattr(backend, 'build_package', lambda settings: pytest.fail('nothing is to be built'))
    info = backend.prepare_metadata_for_build_wheel(tmp_path)
    for file in ('METADATA', 'WHEEL'):
        assert (tmp_path / info / file).read_bytes() == files[f'{info}/{file}']


def test_a_build_folder_may_be_named_and_other_settings_are_refused(backend, source_dir, tmp_path):
    assert backend.build_folder({'build-dir': 'build/mine'}) == source_dir / 'build' / 'mine'
    assert backend.build_folder({'build-dir': str(tmp_path)}) == tmp_path
    assert backend.build_folder(None).parent == source_dir / 'build'
    with pytest.raises(ValueError, match="no config setting 'builddir'; it has build-dir"):
        backend.build_folder({'builddir': 'build/mine'})


def test_the_terminal_is_told_how_far_a_build_is(backend, monkeypatch, capfd):
    monkeypatch.setattr(backend, 'TOLD_EVERY', 0.0)
    terminal = io.StringIO()
    lines = "print('[ 12%] Building A'); print('warning'); print('[3/25] Building B')"
    backend.compile_told([sys.executable, '-c', lines], terminal)
    assert [line.split(' after ')[0] for line in terminal.getvalue().splitlines() if line] == [
        '\033[Kpercale: compiling, 12%', '\033[Kpercale: compiling, 3/25']
    assert capfd.readouterr().out == '[ 12%] Building A\nwarning\n[3/25] Building B\n'  # all of it, for pip -v
    backend.compile_told([sys.executable, '-c', lines], None)
    with pytest.raises(subprocess.CalledProcessError):
        backend.compile_told([sys.executable, '-c', 'raise SystemExit(3)'], None)


def test_a_wheel_can_be_imported_from_where_it_is_unpacked(backend, tmp_path):
    with zipfile.ZipFile(tmp_path / backend.build_wheel(tmp_path)) as wheel:
        wheel.extractall(tmp_path / 'site')
    done = subprocess.run([sys.executable, '-B', '-c', 'import percale; print(percale.__file__, percale.make_box((1, 1, 1)))'],
                          capture_output=True, text=True, check=True, env={'PYTHONPATH': str(tmp_path / 'site')})
    assert done.stdout.startswith(str(tmp_path)) and '8 vertices' in done.stdout


def test_a_source_archive_holds_what_a_build_needs(backend, tmp_path):
    if shutil.which('git') is None:
        pytest.skip('git is not installed')
    name = backend.build_sdist(tmp_path)
    with tarfile.open(tmp_path / name) as archive:
        files = set(archive.getnames())
    folder = name.removesuffix('.tar.gz')
    for file in ('PKG-INFO', 'pyproject.toml', 'CMakeLists.txt', 'LICENSE', 'engine/CMakeLists.txt', 'scenes/python/module.cpp',
                 'scenes/python/percale/__init__.py', 'engine/include/percale/simulation.h'):
        assert f'{folder}/{file}' in files
    assert not any('/build/' in file or '__pycache__' in file for file in files)
    assert not (tmp_path / 'PKG-INFO').exists()
