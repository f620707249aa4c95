"""What layers.py checks of the project's words: the glossary, and the size of READMEs."""
import re
from dataclasses import dataclass

from cpp_functions import LITERAL, without_comments_and_literals

README_LINES, ROOT_README_LINES = 80, 120
README_WIDTH = 120


@dataclass
class Word:
    """A word that the project does not use in some folders, and what it says instead.

    In identifiers it counts as a whole part, singular or plural: `way` forbids `way`, `least_ways` and `WayLimit`, not `always`; a word
    of several parts, `least_share`, forbids those parts in a row. In prose (comments, READMEs) it is looked for only where told,
    as most such words have an everyday meaning.
    """
    forbidden: str
    instead: str
    folders: tuple
    in_prose: bool = False


GLOSSARY = [
    Word('way', 'displacement', ('engine', 'collision', 'scenes')),
]

IDENTIFIER = re.compile(r'[A-Za-z_]\w*')
PARTS = re.compile(r'[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+')
COMMENT_START = re.compile(r'//|/\*')


def parts_of(identifier):
    return '_'.join(part.lower() for part in PARTS.findall(identifier))


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
        if name.group() not in seen:
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


def check_glossary(tree, glossary=None):
    """One complaint an identifier and file, and one a place in prose."""
    for path, text in tree.text.items():
        words = [word for word in (GLOSSARY if glossary is None else glossary) if path.split('/')[0] in word.folders]
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
