#!/usr/bin/env python3
"""Checks what the architecture promises: .ci/layers.py [ROOT].

Include directions, rings, a test file for every source, sizes, public headers, names, texts and words (words.py). One line a violation,
`path:line: what (value, limit)`, then the statistics; exit code 1 if anything is wrong. Standard library only.
"""
import math
import re
import subprocess
import sys
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from cpp_functions import Unbalanced, code_lines, find_functions, plain_code, without_comments_and_literals
from words import check_glossary, check_paths, check_readmes

TOP_LEVEL = {'CMakeLists.txt', 'engine', 'collision', 'scenes', 'tests', 'data', 'README.md', 'LICENSE', 'CMakePresets.json',
             'pyproject.toml', '.ci', '.github', '.clang-format', '.clang-tidy', '.editorconfig', '.gitignore', '.gitattributes'}
LIBRARY = ('engine', 'collision', 'scenes')
CODE_SUFFIXES = ('.cpp', '.h', '.inl')

# Which part may include which, by folder. `public` = engine's public headers, `public_collision` = collision's. Every part of
# engine but `public` may include its tolerances.h; a layer's tolerances.h includes no file of the project.
PUBLIC = {'public', 'public_collision'}
ENGINE_PARTS = ['support', 'kernels', 'mesh', 'model', 'forces', 'contact', 'schemes', 'linear', 'plan', 'solve', 'substep', 'checks',
                'compliant', 'step', 'changes', 'start', 'state']
MAY_INCLUDE = {
    'public': {'public'},
    'public_collision': PUBLIC,
    'support': {'public', 'support'},  # its pool of threads is what the public header of workers promises
    **{part: {'public', *ENGINE_PARTS[:order + 1]} for order, part in enumerate(ENGINE_PARTS) if order},
    'engine': {'public', 'engine', *ENGINE_PARTS},
    'collision': PUBLIC | {'collision'},
    'scenes': PUBLIC | {'scenes'},
    'generators': PUBLIC | {'scenes', 'generators'},
    'tests': PUBLIC | {'engine', *ENGINE_PARTS, 'collision', 'scenes', 'generators', 'tests'},
    'outside': PUBLIC | {'outside'},
}
# The rooms of scenes/, each of which may include itself and the rooms before it.
SCENES_ROOMS = ['common', 'report', 'shapes', 'models', 'meshes', 'frames', 'fields', 'pattern', 'format', 'garment', 'bodies', 'measures', 'run', 'export', 'picture', 'page', 'doctor', 'drape', 'study', 'compare', 'stress', 'python', 'program']
# Which folder of collision may include which other ones; tolerances.h all of them. What stands on top (detector.*) sees all, a
# backend sees the top and what a tree is.
COLLISION_FOLDERS = {
    'geometry': set(), 'certificate': set(),
    'obstacle': {'geometry', 'certificate'}, 'lists': {'geometry', 'obstacle'}, 'self': {'geometry'},
    'untangle': {'geometry', 'certificate'}, 'attach': {'geometry', 'certificate'}, 'c': set(),
    **{backend: {'top', 'geometry', 'obstacle'} for backend in ('fcl', 'bullet', 'brute_force')},
}
# Header prefixes of other projects and the folders that may see them.
OTHERS = [
    (r'fcl/', ('collision/fcl/', 'tests/collision/')),
    (r'ccd/', ('collision/', 'tests/collision/')),
    (r'bullet/|bt[A-Z]|Bullet|LinearMath/', ('collision/bullet/', 'tests/collision/', 'tests/bench/', 'data/examples/')),
    (r'assimp/|toml\+\+/|nlohmann/|CLI/|fmt/|spdlog/|tiny_gltf|stb_|pybind11/', ('scenes/', 'data/generators/', 'tests/scenes/', 'tests/data/', 'tests/validation/',
                                                                       'tests/properties/', 'tests/misuse/', 'tests/bench/')),
    (r'embree3/|stb/', ('scenes/', 'tests/scenes/')),
    (r'catch2/', ('tests/support/',)),
]
# Anything else outside the standard library that engine/ may see.
ENGINE_OTHERS = re.compile(r'Eigen/|percale/|sys/|(?:[a-z]mmintrin|cpuid|unistd|sched|pthread|time)\.h$')

# Sources without a test file of their own, and why.
NO_TEST_FILE = {
    'scenes/program/main.cpp': 'only hands its arguments to the command line; the tests of every command start the program',
}

MOST_FUNCTION_LINES, P90_FUNCTION_LINES, MEDIAN_FUNCTION_LINES = 60, 25, 8
MOST_FILE_LINES, P90_FILE_LINES = 450, 300
MOST_PARAMETERS, DEEPEST_NESTING = 6, 3
MOST_FILE_BYTES = 1 << 20
# Files that may be longer, and why.
LONG_FILES = {}
MOST_FOLDER_FILES = 25
# Folders that may hold more files of their own, and why.
LARGE_FOLDERS = {
    'engine/forces': 'one term a file',
    'scenes/frames': 'one format a file',
    'scenes/program': 'one file a subcommand, by the name that users type',
    'scenes/python': 'one file a part of the module, by what Python users see of it',
    'tests/fuzz/corpus/*': 'inputs that the fuzzers found and nobody reads',
    'data/scenes': 'each stands for itself: users pick one by its name, and programs run all',
}

SNAKE_CASE = re.compile(r'[a-z0-9_]+(?:\.[a-z0-9_]+)*$')
FIXED_NAMES = {'README.md', 'CMakeLists.txt'}
UNFINISHED = re.compile(r'\b(?:' + '|'.join(['TO' + 'DO', 'FIX' + 'ME', 'X' + 'XX', 'HA' + 'CK']) + r')\b')
MACHINE_PATH = re.compile(r'(?<![\w.}])/(?:work|root|home)/|(?<![\w.}])/tmp/[A-Za-z0-9_]')
EIGEN_IN_PUBLIC = re.compile(
    r'\b(?:(?:Row)?Vector[24X][dfi]?|Matrix(?:[24X][dfi]?|[23]X[dfi]?|X[23][dfi]?)|Array(?:XX?|[24])[dfi]?|Quaternion[df]?'
    r'|(?:Isometry|Affine|Transform|Projective)[23]?[df]?|SparseMatrix|Dynamic)\b')
TITLE = re.compile(r'(?:TEST_CASE|SECTION)\(\s*((?:"(?:[^"\\]|\\.)*"\s*)+)')
MAX_COLON = 70
OWN_NAMESPACE = re.compile(r'^namespace (percale::[\w:]+) \{$', re.M)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">\n]+)[">]', re.M)
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/', re.S)


@dataclass
class Tree:
    """The files of the project, read once. Paths are relative, with forward slashes."""
    root: Path
    files: list
    text: dict = field(default_factory=dict)        # of files that are text
    includes: dict = field(default_factory=dict)    # file -> [(line, name, included project file or None)]
    violations: list = field(default_factory=list)

    def code(self, *folders):
        return [f for f in self.files if f.endswith(CODE_SUFFIXES) and f.split('/')[0] in folders]

    def complain(self, path, line, what):
        self.violations.append(f'{path}:{line}: {what}')


def project_files(root):
    """What git tracks or would track; without a repository everything but builds."""
    command = ['git', '-c', 'safe.directory=*', '-C', str(root), 'ls-files', '-co', '--exclude-standard', '-z']
    if (root / '.git').exists():
        found = subprocess.run(command, capture_output=True, check=False)
        if found.returncode == 0:
            return sorted(f for f in found.stdout.decode().split('\0') if f and (root / f).is_file())
    inside = (f.relative_to(root).as_posix() for f in root.rglob('*') if f.is_file())
    return sorted(f for f in inside if not re.match(r'(?:build[^/]*|\.git)/|.*__pycache__/', f))


def changed_files(root, base):
    """Files that differ from those of a commit, and new ones."""
    git = ['git', '-c', 'safe.directory=*', '-C', str(root)]
    found = [subprocess.run([*git, *command], text=True, check=True, capture_output=True).stdout.splitlines()
             for command in (['diff', '--name-only', base], ['ls-files', '-o', '--exclude-standard'])]
    return sorted({path for paths in found for path in paths if path})


def read_tree(root):
    tree = Tree(root, project_files(root))
    for path in tree.files:
        data = (root / path).read_bytes()
        if len(data) > MOST_FILE_BYTES:
            tree.complain(path, 1, f'file too large ({len(data)} bytes, {MOST_FILE_BYTES})')
        elif b'\0' not in data:
            tree.text[path] = data.decode(errors='replace')
    for path in tree.files:
        if path.endswith(CODE_SUFFIXES):
            tree.includes[path] = [resolve(tree, path, found) for found in INCLUDE.finditer(uncommented(tree.text.get(path, '')))]
    return tree


def uncommented(text):
    return COMMENT.sub(lambda found: re.sub(r'[^\n]', ' ', found.group()), text)


def line_of(text, offset):
    return text.count('\n', 0, offset) + 1


def resolve(tree, path, found):
    """(line, name, project file). Looks beside the file, in its layer, in the root, among public headers."""
    quoted, name = found.group(1) == '"', found.group(2)
    layer = path.split('/')[1 if path.startswith('tests/') else 0]
    candidates = [f'{layer_name}/include/{name}' for layer_name in LIBRARY]
    if quoted:
        candidates = [f'{PurePosixPath(path).parent}/{name}', f'{layer}/{name}', name, *candidates]
    known = set(tree.files)
    normal = (re.sub(r'(?:[^/]+/\.\./)+', '', candidate) for candidate in candidates)
    target = next((candidate for candidate in normal if candidate in known), None)
    line = line_of(tree.text[path], found.start())
    if quoted and target is None:
        tree.complain(path, line, f'include "{name}" is no file of the project')
    return line, name, target


def part_of(path):
    parts = path.split('/')
    if parts[0] in ('engine', 'collision') and parts[1] == 'include':
        return 'public' if parts[0] == 'engine' else 'public_collision'
    if parts[0] == 'engine':
        return parts[1] if parts[1] in ENGINE_PARTS else 'engine'
    if path.startswith('data/generators/'):
        return 'generators'
    return parts[0] if parts[0] in ('collision', 'scenes', 'tests') else 'outside'


def room_of(path):
    """The folder of scenes/ that holds a file; None where there is none."""
    parts = path.split('/')
    return parts[1] if parts[0] == 'scenes' and len(parts) > 2 else None


def check_top_level(tree):
    for name in sorted({f.split('/')[0] for f in tree.files} - TOP_LEVEL):
        tree.complain(name, 1, 'not allowed at the top level')
    for path in tree.files:
        parts = path.split('/')
        if parts[0] == 'engine' and len(parts) > 2 and parts[1] not in [*ENGINE_PARTS, 'include', 'cmake']:
            tree.complain(path, 1, f'unknown part of the engine (known: {", ".join(ENGINE_PARTS)})')
        if room_of(path) not in [None, *SCENES_ROOMS]:
            tree.complain(path, 1, f'unknown room of scenes (known: {", ".join(SCENES_ROOMS)})')


def check_directions(tree):
    for path, includes in tree.includes.items():
        part = part_of(path)
        for line, name, target in includes:
            if path.endswith('/tolerances.h') and target is not None:
                tree.complain(path, line, f'tolerances.h must include no file of the project ({name})')
            if target == 'engine/tolerances.h' and path.startswith('engine/') and part != 'public':
                continue
            if target is not None and part_of(target) not in MAY_INCLUDE[part]:
                tree.complain(path, line, f'{part} must not include {part_of(target)} ({name})')
            if target is None:
                check_other_project(tree, path, line, name)
    for path in tree.code('engine'):
        detector = re.search(r'\bContactDetector\b', plain_code(tree.text[path]))
        if path.startswith('engine/forces/') and detector:
            tree.complain(path, line_of(tree.text[path], detector.start()), 'forces must not know the contact detector')


def check_rooms(tree):
    for path, includes in tree.includes.items():
        for line, name, target in includes:
            room, other = room_of(path), room_of(target or '')
            if other is not None and room in SCENES_ROOMS and other not in SCENES_ROOMS[:SCENES_ROOMS.index(room) + 1]:
                tree.complain(path, line, f'scenes/{room} must not include scenes/{other} ({name})')


def check_collision_folders(tree):
    folder_of = lambda path: path.split('/')[1] if path.count('/') > 1 else 'top'
    for path in tree.code('collision'):
        folder = folder_of(path)
        for line, name, target in tree.includes[path]:
            other = folder_of(target) if target and target.startswith('collision/') else folder
            if target == 'collision/tolerances.h' or other in (folder, 'include') or folder == 'top':
                continue
            if other not in COLLISION_FOLDERS.get(folder, set()):
                tree.complain(path, line, f'collision/{folder} must not include collision/{other} ({name})')


def check_other_project(tree, path, line, name):
    if path.startswith('.ci/'):
        return
    for prefix, allowed in OTHERS:
        if re.match(prefix, name):
            if not path.startswith(allowed):
                tree.complain(path, line, f'<{name}> is not allowed here (only in {", ".join(allowed)})')
            return
    standard = re.fullmatch(r'[a-z0-9_]+', name)
    if path.startswith('engine/') and not standard and not ENGINE_OTHERS.match(name):
        tree.complain(path, line, f'<{name}> is not allowed in engine (only Eigen and the standard library)')


def cycles(graph):
    """Strongly connected components of more than one node, or a node that points to itself (Tarjan, without recursion)."""
    number, low, stack, on_stack, found = {}, {}, [], set(), []
    for start in sorted(graph):
        work = [] if start in number else [(start, None)]
        while work:
            node, rest = work.pop()
            if rest is None:
                number[node] = low[node] = len(number)
                stack.append(node)
                on_stack.add(node)
                rest = iter(sorted(graph.get(node, ())))
            for next_node in rest:
                if next_node not in number:
                    work += [(node, rest), (next_node, None)]
                    break
                if next_node in on_stack:
                    low[node] = min(low[node], low[next_node])
            else:
                if low[node] == number[node]:
                    component = stack[stack.index(node):]
                    del stack[stack.index(node):]
                    on_stack -= set(component)
                    found += [sorted(component)] if len(component) > 1 or node in graph.get(node, ()) else []
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
    return found


def module_names(tree):
    """The module of each code file: x.cpp, x.h, x.inl and x_kernel.inl of a folder are one, named by folder/x. A public header
    belongs to the source of its name in its layer."""
    sources = {(path.split('/')[0], PurePosixPath(path).stem): path[:-4] for path in tree.code(*LIBRARY) if path.endswith('.cpp')}
    names = {}
    for path in tree.includes:
        name = re.sub(r'(?:(?<=[^/])_kernel\.inl|\.\w+)$', '', path)
        is_public = '/include/' in path
        names[path] = sources.get((path.split('/')[0], PurePosixPath(path).stem), name) if is_public else name
    return names


def check_modules(tree):
    """Modules, too, include in one direction; files that do not include each other may still make a ring of modules."""
    names, graph = module_names(tree), defaultdict(set)
    for path, includes in tree.includes.items():
        graph[names[path]] |= {names[target] for _, _, target in includes if target in names} - {names[path]}
    for ring in cycles(graph):
        tree.complain(ring[0], 1, f'modules include each other ({", ".join(ring)})')


def check_folder_sizes(tree):
    sizes = Counter(str(PurePosixPath(path).parent) for path in tree.files)
    for folder, size in sorted(sizes.items()):
        if size > MOST_FOLDER_FILES and not any(PurePosixPath(folder).match(large) for large in LARGE_FOLDERS):
            tree.complain(folder, 1, f'too many files in one folder ({size}, {MOST_FOLDER_FILES})')


def check_cycles(tree):
    files, folders = defaultdict(set), defaultdict(set)
    # A layer's tolerances.h includes nothing and is read by all folders: it counts as a folder of its own.
    folder_of = lambda path: path if path.endswith('/tolerances.h') else str(PurePosixPath(path).parent)
    for path, includes in tree.includes.items():
        for _, _, target in includes:
            if target is not None:
                files[path].add(target)
                ends = [folder_of(end) for end in (path, target)]
                folders[ends[0]] |= {ends[1]} - {ends[0]}
    for ring in cycles(files):
        tree.complain(ring[0], 1, f'files include each other ({", ".join(ring)})')
    for ring in cycles(folders):
        tree.complain(ring[0], 1, f'folders include each other ({", ".join(ring)})')


def test_of(path):
    """The Python module is tested from Python."""
    return f'tests/{path[len("scenes/"):-4]}_test.py' if room_of(path) == 'python' else f'tests/{path[:-4]}_test.cpp'


def check_mirror(tree):
    known = set(tree.files)
    for path in [path for path in tree.code(*LIBRARY, 'data') if part_of(path) != 'outside']:
        test = test_of(path)
        if path.endswith('.cpp') and path not in NO_TEST_FILE and test not in known:
            tree.complain(path, 1, f'no test file ({test})')


def percentile(values, share):
    return sorted(values)[max(0, math.ceil(share * len(values)) - 1)]


def check_functions(tree):
    """Limits for all code, the distribution for the library; gives the lengths of the library's functions."""
    lengths = []
    for path in tree.code(*LIBRARY, 'data', 'tests'):
        is_kernel = path.endswith('_kernel.inl')
        try:
            functions = find_functions(tree.text[path])
        except Unbalanced as error:
            tree.complain(path, line_of(tree.text[path], error.offset), str(error))
            continue
        for function in functions:
            check_function(tree, path, function, is_kernel)
        if path.startswith(LIBRARY) and not is_kernel:
            lengths += [function.lines for function in functions if function.lines > 0 and not function.is_lambda]
    return lengths


def check_function(tree, path, function, is_kernel):
    is_macro = re.fullmatch(r'[A-Z][A-Z0-9_]*', function.name)
    limits = [
        ('function too long', function.lines, MOST_FUNCTION_LINES, not is_kernel),
        ('too many parameters', function.parameters, MOST_PARAMETERS, not is_macro),
        ('nested too deep', function.nesting, DEEPEST_NESTING, not is_kernel),
    ]
    for what, value, limit, applies in limits:
        if applies and value > limit:
            tree.complain(path, function.first_line, f'{function.name}: {what} ({value}, {limit})')


def check_files(tree):
    """Length of files; gives the lengths of the library's."""
    lengths = {path: len(tree.text[path].splitlines()) for path in tree.code(*LIBRARY, 'tests')}
    for path, length in lengths.items():
        most, _ = LONG_FILES.get(path, (MOST_FILE_LINES, ''))
        if length > most:
            tree.complain(path, 1, f'file too long ({length}, {most})')
    return [length for path, length in lengths.items() if path.startswith(LIBRARY)]


def check_distribution(tree, what, lengths, share, limit):
    if lengths and percentile(lengths, share) > limit:
        tree.complain('library', 1, f'{what} ({percentile(lengths, share)}, {limit})')


def check_public_headers(tree):
    for path in tree.code(*LIBRARY):
        if '/include/' not in path:
            continue
        code = without_comments_and_literals(tree.text[path])
        for found in EIGEN_IN_PUBLIC.finditer(code):
            tree.complain(path, line_of(code, found.start()), f'{found.group()} in a public header')


def check_names(tree):
    for path in tree.files:
        parts = path.split('/')
        if parts[0] not in (*LIBRARY, 'tests', 'data'):
            continue
        for name in parts:
            if not SNAKE_CASE.match(name) and name not in FIXED_NAMES:
                tree.complain(path, 1, f'name is not snake_case ({name})')
    for path in tree.code(*LIBRARY):
        code = without_comments_and_literals(tree.text[path])
        for found in re.finditer(r'^[ \t]*#[ \t]*define[ \t]+(?!PERCALE_)(\w+)', code, re.M):
            tree.complain(path, line_of(code, found.start()), f'macro does not start with PERCALE_ ({found.group(1)})')


def check_texts(tree):
    for path, text in tree.text.items():
        for pattern, what in ((UNFINISHED, 'unfinished work'), (MACHINE_PATH, 'path of one machine')):
            for found in pattern.finditer(text):
                tree.complain(path, line_of(text, found.start()), f'{what} ({found.group()})')


def outside(namespace, text, commented):
    """What stands before a namespace's line, and behind the comment that ends it."""
    return text[:text.find(f'namespace {namespace} {{')] + commented.partition(f'}}  // namespace {namespace}\n')[2]


def check_test_namespaces(tree):
    """Test files are compiled in batches and have helpers in common, so the cases of each stand in a namespace that ends in its name."""
    holder = {}
    for path in tree.code('tests'):
        if not path.endswith('_test.cpp'):
            continue
        stem, text = PurePosixPath(path).stem, uncommented(tree.text.get(path, ''))
        own = [name for name in OWN_NAMESPACE.findall(text) if re.search(rf'(?:::|_){stem}$', name)]
        if len(own) != 1:
            tree.complain(path, 1, f'no namespace of its own (namespace percale::test::{stem})')
        elif holder.setdefault(own[0], path) != path:
            tree.complain(path, 1, f'namespace {own[0]} is that of {holder[own[0]]}, too')
        elif 'TEST_CASE(' in outside(own[0], text, tree.text[path]):
            tree.complain(path, 1, f'a case outside namespace {own[0]}')


def check_test_titles(tree):
    """Catch 2 writes the rest of a title beside what stands before its first colon; from some 75 columns on the report of a failure
    never ends."""
    for path in tree.code('tests'):
        for found in TITLE.finditer(tree.text[path]):
            colon = ''.join(re.findall(r'"((?:[^"\\]|\\.)*)"', found.group(1))).find(': ')
            if colon > MAX_COLON:
                tree.complain(path, line_of(tree.text[path], found.start()), f'first colon of a title too far right ({colon}, {MAX_COLON})')


def check_test_size(tree):
    library = sum(code_lines(tree.text[path]) for path in tree.code(*LIBRARY))
    tests = sum(code_lines(tree.text[path]) for path in tree.code('tests'))
    if tests < library:
        tree.complain('tests', 1, f'less test code than library code ({tests}, {library})')
    return library, tests


RULES = (check_top_level, check_directions, check_rooms, check_collision_folders, check_cycles, check_modules,
         check_folder_sizes, check_mirror, check_public_headers, check_names, check_texts, check_test_namespaces,
         check_test_titles, check_readmes, check_paths, check_glossary)


def check(root):
    """Gives (violations, summary)."""
    tree = read_tree(Path(root))
    for rule in RULES:
        rule(tree)
    functions, files = check_functions(tree), check_files(tree)
    check_distribution(tree, 'p90 of function lines', functions, 0.9, P90_FUNCTION_LINES)
    check_distribution(tree, 'median of function lines', functions, 0.5, MEDIAN_FUNCTION_LINES)
    check_distribution(tree, 'p90 of file lines', files, 0.9, P90_FILE_LINES)
    library, tests = check_test_size(tree)
    spread = lambda values: '/'.join(str(percentile(values, share)) for share in (0.5, 0.9, 1.0)) if values else '-'
    summary = (f'layers: {len(tree.files)} files; library {len(files)} files, lines median/p90/most {spread(files)}; '
               f'{len(functions)} functions, lines median/p90/most {spread(functions)}; '
               f'code lines library {library}, tests {tests}; {len(tree.violations)} violations')
    return tree.violations, summary


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    violations, summary = check(root)
    print('\n'.join([*violations, summary]))
    return 1 if violations else 0


if __name__ == '__main__':
    sys.exit(main())
