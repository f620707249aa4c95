"""Finds the functions of C++ text, well enough to measure them: no preprocessing, no types.

Braces are matched after comments, literals and preprocessor lines are blanked, then every `{` is judged by the text before it.
Lambdas belong to the function around them (their lines count there), but their bodies start at nesting 0 again.
"""
import bisect
import re
from dataclasses import dataclass

LITERAL = re.compile(
    r'//(?:[^\n\\]|\\.|\\\n)*'
    r'|/\*.*?\*/'
    r'|(?:\b(?:u8|[uUL]))?R"(?P<mark>[^\s()\\]{0,16})\(.*?\)(?P=mark)"'
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|(?<![0-9A-Za-z_])(?:u8|[uUL])?'(?:[^'\\\n]|\\.)+'",
    re.S)
DIRECTIVE = re.compile(r'^[ \t]*#(?:[^\n\\]|\\.|\\\n)*', re.M | re.S)
CLOSING = {'(': ')', '[': ']', '{': '}'}
LAMBDA_TAIL = re.compile(r'(?:\s|mutable\b|noexcept\b|constexpr\b)*(?:->[^;{}()]*)?\{')
# Names before a parenthesis that do not make it a parameter list.
NOT_A_NAME = {'requires', 'noexcept', 'decltype', 'alignas', 'explicit', '__attribute__', '__declspec', 'throw', 'if', 'while'}
CONTROL = re.compile(r'\s*(else\s+if\b|else\b|if\b|for\b|while\b|switch\b|do\b)\s*(?:constexpr\b\s*)?(?:\(\))?')
LABEL = re.compile(r'\s*(?:case\b(?:[^:]|::)*:(?!:)|default\s*:(?!:))')
JUMP = re.compile(r'\s*(?:continue|break|return|throw)\b')


class Unbalanced(Exception):
    """Braces that do not match; `offset` is where."""

    def __init__(self, offset):
        super().__init__('brackets do not match')
        self.offset = offset


@dataclass
class Function:
    name: str
    first_line: int
    lines: int
    parameters: int
    nesting: int = 0
    is_lambda: bool = False


def _blank(match):
    """Spaces for text, so that offsets stay; a string leaves its quotes so that `f("a", "b")` still shows two arguments."""
    blanks = re.sub(r'[^\n]', ' ', match.group())
    return '0' + blanks[1:] if match.group()[0] not in '/#' else blanks


def without_comments_and_literals(text):
    return LITERAL.sub(_blank, text)


def plain_code(text):
    """The text with comments, literals and preprocessor lines blanked; same length, same lines."""
    return DIRECTIVE.sub(_blank, without_comments_and_literals(text))


def _matching_brackets(code):
    partner, open_ones = {}, []
    for found in re.finditer(r'[()\[\]{}]', code):
        offset, bracket = found.start(), found.group()
        if bracket in CLOSING:
            open_ones.append(offset)
        else:
            if not open_ones or CLOSING[code[open_ones[-1]]] != bracket:
                raise Unbalanced(offset)
            partner[open_ones.pop()] = offset
    if open_ones:
        raise Unbalanced(open_ones[-1])
    return partner


def _after_angles(text):
    """Offset behind the `>` that closes the `<` at the start of text."""
    depth = 0
    for offset, letter in enumerate(text):
        depth += (letter == '<') - (letter == '>')
        if depth == 0:
            return offset + 1
    return len(text)


def count_parameters(inside):
    if inside.strip() in ('', 'void'):
        return 0
    depth, count = 0, 1
    for letter in inside.replace('->', '  '):
        depth += (letter in '<([{') - (letter in '>)]}')
        count += letter == ',' and depth == 0
    return count


class Finder:
    """One pass over one file. Declarations and statements are walked separately: a `{` means different things in them."""

    def __init__(self, text):
        self.code = plain_code(text)
        self.partner = _matching_brackets(self.code)
        self.line_starts = [0] + [found.end() for found in re.finditer('\n', self.code)]
        self.functions = []
        self.deepest = 0

    def line(self, offset):
        return bisect.bisect_right(self.line_starts, offset)

    def _masked(self, start, end):
        """Text from start to end with the inside of every bracket left out."""
        pieces, offset = [], start
        while offset < end:
            letter = self.code[offset]
            if offset in self.partner:
                pieces.append(letter + CLOSING[letter])
                offset = self.partner[offset] + 1
            else:
                pieces.append(letter)
                offset += 1
        return ''.join(pieces)

    def _signature(self, start, end):
        """(name, parameter list's offset) if the text before a brace is a function's head, else None."""
        offset, name = start, ''
        while offset < end:
            word = re.compile(r'operator\s*(?:\(\s*\)|\[\s*\]|[^\s\w(]+|[\w:<>*& ]+?(?=\())|~?[A-Za-z_]\w*').match(self.code, offset)
            letter = self.code[offset]
            if word:
                name, offset = word.group(), word.end()
                if name == 'template':
                    skip = re.match(r'\s*', self.code[offset:end]).end()
                    offset += skip + _after_angles(self.code[offset + skip:end])
                continue
            if letter == '(' and name and name not in NOT_A_NAME:
                return name, offset
            if letter in '={' or (letter == ':' and self.code[offset:offset + 2] != '::' and self.code[offset - 1] != ':'):
                return None
            offset = self.partner[offset] + 1 if offset in self.partner else offset + 1
            name = '' if not letter.isspace() and letter not in '>' else name
        return None

    def _head_start(self, start, end):
        """Skips blanks and access labels before a declaration."""
        labels = re.compile(r'(?:\s+|(?:public|private|protected)\s*:(?!:))*')
        return labels.match(self.code, start, end).end()

    def _starts_body(self, parameters, end):
        """False for the braces of a constructor's member initialisers, `: a_{1}, b_{2} {`."""
        tail = self._masked(self.partner[parameters] + 1, end)
        is_initialiser_list = re.match(r'(?:\s|noexcept\b|\(\))*:(?!:)', tail)
        return not (is_initialiser_list and re.search(r'[\w>]\s*$', tail))

    def declarations(self, start, end):
        """Namespace or class scope."""
        offset = head = start
        while offset < end:
            letter = self.code[offset]
            if letter == ';':
                self._pure_virtual(self._head_start(head, offset), offset)
                head = offset + 1
            elif letter in '([':
                self.expression(offset + 1, self.partner[offset])
                offset = self._lambda(offset) or self.partner[offset]
            elif letter == '{':
                head = self._declared_brace(self._head_start(head, offset), offset)
                offset = self.partner[offset]
            offset += 1

    def _declared_brace(self, head, brace):
        """Handles one brace of a declaration; gives where the next declaration's head starts."""
        close = self.partner[brace]
        signature = self._signature(head, brace)
        masked = self._masked(head, brace)
        if signature and self._starts_body(signature[1], brace):
            self._body(signature, head, brace)
        elif signature:
            self.expression(brace + 1, close)
            return head
        elif re.search(r'\benum\b', masked):
            pass
        elif re.search(r'\b(?:namespace|class|struct|union|extern)\b', masked) and '=' not in masked.split('>')[-1]:
            self.declarations(brace + 1, close)
        else:
            self.expression(brace + 1, close)
            return head
        return close + 1

    def _pure_virtual(self, head, end):
        if re.search(r'=\s*0\s*$', self.code[head:end]) and (signature := self._signature(head, end)):
            parameters = count_parameters(self.code[signature[1] + 1:self.partner[signature[1]]])
            self.functions.append(Function(signature[0], self.line(head), 0, parameters))

    def _body(self, signature, head, brace):
        name, list_start = signature
        close = self.partner[brace]
        first = self.line(head)
        parameters = count_parameters(self.code[list_start + 1:self.partner[list_start]])
        found = Function(name, first, self.line(close) - first + 1, parameters)
        self.functions.append(found)
        outer, self.deepest = self.deepest, 0
        self.statements(brace + 1, close, 0)
        found.nesting, self.deepest = self.deepest, outer

    def _lambda(self, offset):
        """If a lambda starts at this bracket, walks it and gives the offset of its closing brace."""
        if self.code[offset] != '[' or self.code[offset + 1] == '[':
            return None
        before = re.search(r'(\w+|[^\s\w])?\s*$', self.code[max(0, offset - 40):offset]).group(1) or ''
        if before in (')', ']') or (before[:1].isalnum() or before[:1] == '_') and before not in ('return', 'else', 'case'):
            return None
        tail = self.partner[offset] + 1
        parameters = 0
        opening = re.compile(r'\s*(?:<[^(){}]*>\s*)?\(').match(self.code, tail)
        if opening:
            list_start = opening.end() - 1
            tail = self.partner[list_start] + 1
            parameters = count_parameters(self.code[list_start + 1:tail - 1])
        brace = LAMBDA_TAIL.match(self.code, tail)
        if not brace:
            return None
        close = self.partner[brace.end() - 1]
        first = self.line(offset)
        found = Function('lambda', first, self.line(close) - first + 1, parameters, is_lambda=True)
        self.functions.append(found)
        outer, self.deepest = self.deepest, 0
        self.statements(brace.end(), close, 0)
        found.nesting, self.deepest = self.deepest, outer
        return close

    def expression(self, start, end):
        """Inside parentheses or an initialiser only lambdas are of interest."""
        offset = start
        while offset < end:
            offset = (self._lambda(offset) or offset) + 1 if self.code[offset] == '[' else offset + 1

    def statements(self, start, end, depth):
        """Body of a function; depth is the nesting of control flow around it."""
        offset = head = start
        while offset < end:
            letter = self.code[offset]
            if letter == ';':
                self._plain_statement(head, offset, depth)
                head = offset + 1
            elif letter == '[' and (close := self._lambda(offset)):
                offset = close
            elif letter in '([':
                self.expression(offset + 1, self.partner[offset])
                offset = self.partner[offset]
            elif letter == '{':
                head = self._statement_brace(head, offset, depth)
                offset = self.partner[offset]
            offset += 1

    def _controls(self, masked):
        """(number of nested control statements a head opens, what follows them)."""
        while label := LABEL.match(masked):
            masked = masked[label.end():]
        levels = 0
        while control := CONTROL.match(masked):
            levels += 1
            masked = masked[control.end():]
        return levels, masked.strip()

    def _plain_statement(self, head, end, depth):
        """A statement without braces. A guard, `if (…) return;`, opens no level."""
        levels, rest = self._controls(self._masked(head, end))
        if levels and JUMP.match(rest):
            levels -= 1
        self.deepest = max(self.deepest, depth + levels) if levels else self.deepest

    def _statement_brace(self, head, brace, depth):
        close = self.partner[brace]
        levels, rest = self._controls(self._masked(head, brace))
        is_block = not rest or rest == 'try' or re.match(r'catch\b|[A-Z][A-Z0-9_]*\s*\(\)$', rest)
        if is_block:
            self.deepest = max(self.deepest, depth + levels)
            self.statements(brace + 1, close, depth + levels)
            return close + 1
        if re.match(r'(?:struct|class|union)\b[^()=]*$', rest):
            self.declarations(brace + 1, close)
            return close + 1
        self.expression(brace + 1, close)
        return head


def find_functions(text):
    """All functions and lambdas with bodies, and pure virtual functions (0 lines). Raises Unbalanced."""
    finder = Finder(text)
    finder.declarations(0, len(finder.code))
    return finder.functions


def code_lines(text):
    """Lines that are neither blank nor only comment."""
    blank = lambda found: re.sub(r'[^\n]', ' ', found.group()) if found.group()[0] == '/' else found.group()
    return sum(1 for line in LITERAL.sub(blank, text).splitlines() if line.strip())
