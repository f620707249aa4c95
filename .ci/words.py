"""What layers.py checks of the project's words: the glossary, the size of READMEs, and the paths that they name."""
import functools
import re
from dataclasses import dataclass
from posixpath import normpath

from cpp_functions import LITERAL, without_comments_and_literals

README_LINES, ROOT_README_LINES = 80, 120
README_WIDTH = 120


@dataclass
class Word:
    """A word that the project does not use below some paths, and what it says instead.

    In identifiers it counts as a whole part, singular or plural: `way` forbids `way`, `least_ways` and `WayLimit`, not `always`; a word
    of several parts, `least_share`, forbids those parts in a row. In prose (comments, READMEs) it is looked for only where told,
    as most such words have an everyday meaning.
    """
    forbidden: str
    instead: str
    paths: tuple
    in_prose: bool = False


CODE = ('engine', 'collision', 'scenes', 'tests')
CONTACT = ('engine/contact', 'engine/solve', 'engine/substep', 'engine/step', 'engine/checks', 'collision/lists', 'collision/self',
           'collision/detector', 'tests/engine/contact', 'tests/engine/solve', 'tests/engine/substep', 'tests/engine/step')
FRICTION = ('engine/contact', 'tests/engine/contact')

# Private words, with the field's.
GLOSSARY = [
    Word('way', 'displacement', ('engine', 'collision', 'scenes')),
    Word('row', 'contact constraint (rows are those of a matrix or a table)', CONTACT),
    Word('contact_row', 'contact constraint', ('engine', 'collision'), True),
    Word('zone', 'activation distance', ('engine', 'collision', 'tests/engine', 'tests/collision'), True),
    Word('row_share', 'edge-edge mollifier', CODE, True),
    Word('standing', 'persistent', ('collision/lists', 'collision/detector', 'tests/collision/lists')),
    Word('contact_memory', 'warm start', CODE, True),
    Word('self_group', 'island', CODE, True),
    Word('group', 'island', ('collision/self', 'tests/collision/self')),
    Word('cut', 'clamp', ('collision/self', 'collision/geometry', 'collision/lists', 'collision/detector')),
    Word('safe_fraction', 'collision-free step size', CODE, True),
    Word('safe_time', 'time-of-impact lower bound', CODE, True),
    Word('touch', 'friction contact', FRICTION),
    Word('rub', 'cloth-cloth friction contact', CODE, True),
    Word('grip', 'stick anchor', ('engine', 'collision', 'tests/engine', 'tests/collision'), True),
    Word('reach', 'stick threshold', ('engine/contact/friction', 'engine/contact/penalty', 'tests/engine/contact/friction',
                                      'tests/engine/contact/penalty')),
    Word('press', 'friction limit, or normal force', FRICTION),
    Word('heading', 'slip direction', ('engine', 'tests/engine')),
    Word('obstacle_flow', 'obstacle motion', CODE, True),
    Word('span_end', 'substep outcome', CODE, True),
    Word('span_result', 'substep result', CODE, True),
    Word('dropped_span', 'dropped substep', CODE, True),
    Word('patch', 'local subset', ('engine/solve', 'engine/linear', 'tests/engine/solve', 'tests/engine/linear'), True),
    Word('gain_record', 'energy-error estimate', CODE, True),
    Word('most_turned', 'curvature condition', CODE, True),
    Word('armijo_share', 'Armijo constant', CODE, True),
    Word('translations', 'rigid-mode correction', ('engine/solve', 'tests/engine/solve'), True),
    Word('enclosed_block', 'outer block', CODE, True),
    Word('filling', 'gas state', ('engine/forces', 'tests/engine/forces')),
    Word('float_vector', 'Vec3 arrays', CODE),
    Word('for_stretche', 'parallel_for_chunks', CODE),
    Word('stretch_count', 'chunk count', CODE),
    Word('dent', 'deflection', ('engine', 'tests/engine'), True),
    Word('yielding', 'compliant obstacle', CODE),
    Word('newton_share', 'newton_error_ratio', ('engine', 'scenes')),
    Word('tell', 'report', ('engine', 'collision', 'scenes', 'tests')),
    Word('told', 'reported', ('engine', 'collision', 'scenes', 'tests')),
    Word('most', 'max', ('engine', 'collision', 'scenes')),
    Word('least', 'min', ('engine', 'collision', 'scenes')),
]

# Names that users have, and everyday words in whose identifiers the glossary does not look.
NOT_SEARCHED = {'contacts_most', 'at_most', 'at_least', 'at_least_one', 'at_least_one_why', 'line_search_cuts', 'most_pairs', 'most_tests'}

IDENTIFIER = re.compile(r'[A-Za-z_]\w*')
PARTS = re.compile(r'[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+')
COMMENT_START = re.compile(r'//|/\*')


@functools.cache
def parts_of(identifier):
    return '_'.join(part.lower() for part in PARTS.findall(identifier))


@functools.cache
def forbids(word, text):
    """Whether snake_case text holds the word's parts in a row, or its plural."""
    return re.search(rf'(?:^|_){re.escape(word)}s?(?:_|$)', text) is not None


def line_of(text, offset):
    return text.count('\n', 0, offset) + 1


def comments(text):
    """Offset and text of each comment of C++ text."""
    return [(found.start(), found.group()) for found in LITERAL.finditer(text) if COMMENT_START.match(found.group())]


def words_in_code(text, words):
    """(line, word, identifier or None for prose), each identifier once a file."""
    code, seen, found = without_comments_and_literals(text), set(), []
    for name in IDENTIFIER.finditer(code):
        if name.group() not in seen | NOT_SEARCHED:
            seen.add(name.group())
            snake = parts_of(name.group())
            found += [(line_of(code, name.start()), word, name.group()) for word in words if forbids(word.forbidden, snake)]
    for offset, comment in comments(text):
        found += [(line_of(text, offset) + line - 1, word, None) for line, word, _ in words_in_prose(comment, words)]
    return found


def words_in_prose(text, words):
    pattern = lambda word: rf'(?<!\w){re.escape(word.forbidden.replace("_", " "))}s?(?!\w)'
    return [(line_of(text, found.start()), word, None) for word in words if word.in_prose
            for found in re.finditer(pattern(word), text, re.I)]


@functools.cache
def is_below(path, start):
    """Whether a path begins with another, up to the end of one of its parts or of a file's name."""
    return re.match(rf'{re.escape(start)}(?![a-z0-9])', path) is not None


def check_glossary(tree, glossary=None):
    """One complaint an identifier and file, and one a place in prose."""
    for path, text in tree.text.items():
        words = [word for word in (GLOSSARY if glossary is None else glossary) if any(is_below(path, start) for start in word.paths)]
        if path.endswith(('.cpp', '.h', '.inl')):
            found = words_in_code(text, words)
        else:
            found = words_in_prose(text, words) if path.endswith('README.md') else []
        for line, word, identifier in sorted(found, key=lambda one: one[0]):
            where = f' in {identifier}' if identifier else ''
            tree.complain(path, line, f'"{word.forbidden}"{where}: the glossary says {word.instead}')


def prose_lines(text):
    """(number, line) outside fenced and indented code, tables and lines that are only a link's target."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith('```'):
            fenced = not fenced
        elif not fenced and not re.match(r'    |\t|\s*\||\[[^\]]*\]: ', line):
            yield number, line


def check_readmes(tree):
    for path, text in tree.text.items():
        if path.split('/')[-1] != 'README.md':
            continue
        most, length = README_LINES if '/' in path else ROOT_README_LINES, len(text.splitlines())
        if length > most:
            tree.complain(path, 1, f'README too long ({length} lines, {most})')
        for number, line in prose_lines(text):
            if len(line) > README_WIDTH:
                tree.complain(path, number, f'line of a README too wide ({len(line)}, {README_WIDTH})')


PATH = re.compile(r'`([\w./{},-]+/[\w./{},-]*)`|\]\((?!https?:)([^)#\s]+)')
OF_FORM = re.compile(r'NAME|(?<![a-z])x_test|(?<![a-z])x\.')   # of any file of its kind


def alternatives(path):
    """`a.{h,cpp}` as both of its paths."""
    braces = re.search(r'\{([^}]*)\}', path)
    if not braces:
        return [path]
    return [one for end in braces.group(1).split(',') for one in alternatives(path[:braces.start()] + end + path[braces.end():])]


def check_paths(tree):
    """Files and folders that prose names, from the top or from its own folder, exist. Those of builds and runs are not looked for."""
    known = set(tree.files) | {path.rsplit('/', n)[0] for path in tree.files for n in range(1, path.count('/') + 1)}
    tops = {path.split('/')[0] for path in known}
    for file, text in tree.text.items():
        if not file.endswith('.md'):
            continue
        folder = file.rpartition('/')[0]
        for found in PATH.finditer(text):
            for path in alternatives(found.group(1) or found.group(2)):
                starts = ['', folder] if found.group(1) else [folder]
                is_ours = not found.group(1) or path.split('/')[0] in tops
                if is_ours and not OF_FORM.search(path) and not any(normpath(f'{start}/{path}').strip('/') in known for start in starts):
                    tree.complain(file, line_of(text, found.start()), f'there is no {path}')
