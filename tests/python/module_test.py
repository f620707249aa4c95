"""The module as a whole: names, docstrings and type stubs."""
import ast
import builtins
import inspect
import re
from pathlib import Path

import pytest

import percale

STUB = ast.parse((Path(percale.__file__).parent / '__init__.pyi').read_text())
IN_STUB = {node.name: node for node in STUB.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
CLASSES = [name for name in percale.__all__ if inspect.isclass(getattr(percale, name))]
FUNCTIONS = [name for name in percale.__all__ if name not in CLASSES]
PLAIN = {'__init__', '__eq__', '__iter__', '__hash__', '__repr__'}


def stub_arguments(node):
    """Names of arguments, self left out; of **keywords not."""
    names = [argument.arg for argument in [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]]
    return [name for name in names if name != 'self']


def stub_defaults(node):
    last = node.args.args[len(node.args.args) - len(node.args.defaults):]
    return {argument.arg: value.value for argument, value in zip(last, node.args.defaults)
            if isinstance(value, ast.Constant) and value.value is not ...}


def signature(call):
    """(names, defaults) of a function of the module, by the first line of its docstring."""
    line = call.__doc__.splitlines()[0]
    inside = line[line.index('(') + 1:line.rindex(') ->')]
    parts = [part.strip() for part in re.split(r',\s+(?=\*{0,2}\w+:|\*)', inside) if part.strip()]
    names, defaults = [], {}
    for part in parts:
        found = re.match(r'(\*{0,2}\w+)(?::[^=]*)?(?:\s=\s(.*))?$', part)
        name, default = found.groups()
        if name.startswith('*') or name == 'self':
            continue
        names.append(name)
        if default is not None and not default.startswith('inf'):
            defaults[name] = ast.literal_eval(default)
    return names, defaults


def members(kind):
    return {name: value for name, value in vars(kind).items() if not name.startswith('_')}


def test_the_stub_has_every_public_name_and_no_other():
    keys = {name for name in IN_STUB if name.endswith('Keys')}
    assert set(IN_STUB) - keys == set(percale.__all__)
    assert {'Simulation', 'Fabric', 'run', 'check', 'certify', 'load_scene', 'SceneError'} <= set(percale.__all__)


@pytest.mark.parametrize('name', [name for name in FUNCTIONS if name != 'check'])
def test_functions_have_the_arguments_of_the_stub_and_a_docstring(name):
    call = getattr(percale, name)
    assert len(call.__doc__.splitlines()) > 2
    assert signature(call) == (stub_arguments(IN_STUB[name]), stub_defaults(IN_STUB[name]))
    assert call.__module__ == 'percale'


@pytest.mark.parametrize('name', [name for name in CLASSES if not issubclass(getattr(percale, name), Exception)])
def test_classes_have_the_members_of_the_stub(name):
    kind, stub = getattr(percale, name), IN_STUB[name]
    in_stub = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
    assert set(members(kind)) == {member for member in in_stub if member not in PLAIN}
    assert kind.__module__ == 'percale' and len(kind.__doc__) > 20
    for member, value in members(kind).items():
        is_property = isinstance(value, property)
        assert is_property == any(isinstance(d, ast.Name) and d.id == 'property' for d in in_stub[member].decorator_list), member
        if not is_property:
            assert len(value.__doc__.splitlines()) > 2, member
            assert signature(value) == (stub_arguments(in_stub[member]), stub_defaults(in_stub[member])), member


@pytest.mark.parametrize('keys, options', [
    ('StepKeys', percale.step_options), ('FabricKeys', percale.fabric_options)])
def test_keywords_of_the_stub_are_those_of_the_tables(keys, options):
    in_stub = {node.target.id: ast.unparse(node.annotation) for node in IN_STUB[keys].body}
    table = options()
    assert set(in_stub) - {'gravity', 'wind'} == set(table)
    for name, option in table.items():
        kind, annotation = option['kind'], in_stub[name]
        if name == 'preset':
            continue
        for choice in option['choices']:
            assert f"'{choice}'" in annotation, name
        assert ('bool' in annotation) == (kind == 'true or false'), name
        assert ("'auto'" in annotation) == ('auto' in kind or 'auto' in option['choices']), name
        assert (annotation.split(' ')[0] == 'int') == ('whole' in kind), name


def test_the_stub_is_python_whose_names_are_all_known():
    names = {node.id for node in ast.walk(STUB) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
    imported = {alias.name for node in STUB.body if isinstance(node, ast.ImportFrom) for alias in node.names} | {'np'}
    assigned = {node.targets[0].id for node in STUB.body if isinstance(node, ast.Assign)}
    known = imported | assigned | set(IN_STUB) | set(dir(builtins))
    assert names - known == set()
    assert (Path(percale.__file__).parent / 'py.typed').exists()


def test_the_version_is_that_of_the_project(source_dir):
    assert f'project(percale VERSION {percale.__version__} ' in (source_dir / 'CMakeLists.txt').read_text()
