"""What pip calls for `pip install .` (PEP 517): builds the module by CMake and packs it as a wheel.

Standard library alone, so nothing is downloaded. The build is kept in build/pip-TAG of the checkout, or in the folder that
`--config-settings build-dir=FOLDER` names (from the checkout): a second install is quick.
CMake's own environment variables (CXX, CMAKE_GENERATOR, CMAKE_BUILD_PARALLEL_LEVEL) hold. pip shows what a build prints only with -v,
so how far compiling has come is also written to the terminal, where there is one.
"""
import base64
import contextlib
import hashlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import time
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
TAG = f'cp{sys.version_info.major}{sys.version_info.minor}'
TOLD_EVERY = 5.0  # s


def project():
    """(name, version, text of METADATA)."""
    table = tomllib.loads((ROOT / 'pyproject.toml').read_text())['project']
    version = re.search(r'project\(percale VERSION ([\d.]+)', (ROOT / 'CMakeLists.txt').read_text()).group(1)
    lines = ['Metadata-Version: 2.1', f'Name: {table["name"]}', f'Version: {version}', f'Summary: {table["description"]}',
             f'License: {table["license"]["text"]}', f'Requires-Python: {table["requires-python"]}',
             *(f'Requires-Dist: {need}' for need in table['dependencies'])]
    return table['name'], version, '\n'.join(lines) + '\n'


def platform_tag():
    return re.sub(r'[^A-Za-z0-9]', '_', sysconfig.get_platform())


def build_folder(config_settings):
    settings = dict(config_settings or {})
    build = ROOT / settings.pop('build-dir', f'build/pip-{TAG}-{platform_tag()}')
    if settings:
        raise ValueError(f'percale has no config setting {", ".join(map(repr, sorted(settings)))}; it has build-dir')
    return build


def open_terminal():
    """The terminal that somebody watches while pip keeps our output; None where there is none."""
    try:
        return open('/dev/tty', 'w', encoding='utf-8')
    except OSError:
        return None


def compile_told(command, terminal):
    """Runs a build; of its lines `[ 12%] ...` or `[3/25] ...` the terminal gets one every few seconds."""
    started = told = time.monotonic()
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, text=True) as building:
        for line in building.stdout:
            print(line, end='', flush=True)
            progress = re.match(r'\[ *(\d+%|\d+/\d+)\]', line)
            if terminal and progress and time.monotonic() - told >= TOLD_EVERY:
                told = time.monotonic()
                print(f'\r\033[Kpercale: compiling, {progress.group(1)} after {told - started:.0f} s', file=terminal, flush=True)
    if building.returncode != 0:
        raise subprocess.CalledProcessError(building.returncode, command)


def build_package(config_settings=None):
    """The folder of the package, built and then installed to where nothing else lies."""
    build = build_folder(config_settings)
    build.mkdir(parents=True, exist_ok=True)
    jobs = os.environ.get('CMAKE_BUILD_PARALLEL_LEVEL', str(os.cpu_count() or 1))
    subprocess.run(['cmake', '-S', ROOT, '-B', build, '-DCMAKE_BUILD_TYPE=Release', '-DPERCALE_PYTHON=ON', '-DPERCALE_TESTS=OFF',
                    f'-DPython3_EXECUTABLE={sys.executable}'], check=True)
    with open_terminal() or contextlib.nullcontext() as terminal:
        if terminal:
            print(f'\r\033[Kpercale: compiling in {build}, which takes minutes', file=terminal, flush=True)
        compile_told(['cmake', '--build', build, '--target', 'percale_python', '--parallel', jobs], terminal)
    stage = build / 'wheel'
    shutil.rmtree(stage, ignore_errors=True)
    subprocess.run(['cmake', '--install', build, '--prefix', stage, '--component', 'python', '--strip'], check=True)
    return Path(sysconfig.get_path('platlib', 'posix_prefix', vars={'base': stage, 'platbase': stage})) / 'percale'


def wheel_tag():
    return f'{TAG}-{TAG}-{platform_tag()}'


def wheel_text():
    return f'Wheel-Version: 1.0\nGenerator: percale\nRoot-Is-Purelib: false\nTag: {wheel_tag()}\n'


def record_line(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()
    return f'{name},sha256={digest},{len(data)}\n'


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    name, version, metadata = project()
    info = Path(metadata_directory) / f'{name}-{version}.dist-info'
    info.mkdir()
    (info / 'METADATA').write_text(metadata)
    (info / 'WHEEL').write_text(wheel_text())
    return info.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name, version, metadata = project()
    info = f'{name}-{version}.dist-info'
    package = build_package(config_settings)
    members = {f'percale/{file.name}': file.read_bytes() for file in sorted(package.iterdir()) if file.is_file()}
    members[f'{info}/METADATA'] = metadata.encode()
    members[f'{info}/WHEEL'] = wheel_text().encode()
    members[f'{info}/LICENSE'] = (ROOT / 'LICENSE').read_bytes()
    record = ''.join(record_line(file, data) for file, data in members.items()) + f'{info}/RECORD,,\n'
    members[f'{info}/RECORD'] = record.encode()
    wheel = f'{name}-{version}-{wheel_tag()}.whl'
    with zipfile.ZipFile(Path(wheel_directory) / wheel, 'w', zipfile.ZIP_DEFLATED) as archive:
        for file, data in members.items():
            archive.writestr(file, data)
    return wheel


def source_files():
    """What git tracks, or without git everything but builds."""
    if (ROOT / '.git').exists():
        listed = subprocess.run(['git', '-C', ROOT, 'ls-files', '-z'], check=True, capture_output=True).stdout.decode()
        return [file for file in listed.split('\0') if (ROOT / file).is_file()]
    files = (file.relative_to(ROOT) for file in ROOT.rglob('*') if file.is_file())
    return sorted(str(file) for file in files if not file.parts[0].startswith('build') and '__pycache__' not in file.parts)


def build_sdist(sdist_directory, config_settings=None):
    name, version, metadata = project()
    folder = f'{name}-{version}'
    with tarfile.open(Path(sdist_directory) / f'{folder}.tar.gz', 'w:gz', format=tarfile.PAX_FORMAT) as archive:
        for file in source_files():
            archive.add(ROOT / file, f'{folder}/{file}')
        info = Path(sdist_directory) / 'PKG-INFO'
        info.write_text(metadata)
        archive.add(info, f'{folder}/PKG-INFO')
        info.unlink()
    return f'{folder}.tar.gz'
