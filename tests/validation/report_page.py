#!/usr/bin/env python3
"""Opens the page of a run in a browser: report_page.py PERCALE SCENE [-o FOLDER] [--browser PROGRAM]

Runs SCENE (its cloth a poncho, its obstacle a mannequin) for a short while with --report and opens the page in headless Chromium, whose
WebGL is computed by the CPU. Wide and narrow, light and dark, no line on the console is allowed, nothing may be wider than the window,
the picture must show something, two frames must differ, and playing must move time. Keys, slider, diagrams, the worst frame and colours
must do what they say. A page without frames whose title is markup and a browser without WebGL must show their tables. A page that was
broken on purpose must be found out. Without Chromium or pages nothing is tested (exit code 77). -o keeps pages and screenshots. Exit
code 1 if anything was not as it should be.
"""
import argparse
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')
SECONDS = 120                 # that one page may take on a busy machine
VIRTUAL_MS = 8000             # of the page's own clock
TRIES = 4                     # on a busy machine that clock may run out before a page is drawn
WIDE, NARROW = (1280, 900), (390, 844)   # pixels
WINDOW = (600, 900)           # around the narrow page: windows of Chromium are not as narrow as a phone
LEAST_COVERED = 0.01          # share of the picture's pixels that meshes cover
MARKUP = '<img src=x onerror=document.body.dataset.ran=1><script>document.body.dataset.ran=1</script>'

FRAME = '''<!DOCTYPE html><body><script>
addEventListener('message', event => Object.assign(document.body.dataset, event.data));
</script><iframe src="%s#test" style="border:0;width:%dpx;height:%dpx"></iframe>'''

# What a visitor does, and where the page is after it; the last frame is 9.
USE = r'''<script>
setTimeout(() => {
  const find = words => [...document.querySelectorAll('button, label')].find(one => one.textContent.trim() === words);
  const told = {}, clock = () => Number(document.getElementById('clock').textContent.match(/frame (\d+)/)[1]);
  const press = (key, more) => document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true, ...more }));
  told.start = clock();
  press('ArrowLeft'); told.left = clock();
  press('Home'); told.home = clock();
  press('ArrowRight'); told.right = clock();
  const slider = document.querySelector('input[type=range]');
  slider.value = 6; slider.dispatchEvent(new Event('input')); told.slider = clock();
  const svg = document.querySelector('.diagram svg'), box = svg.getBoundingClientRect();
  svg.dispatchEvent(new MouseEvent('click', { clientX: box.right, clientY: box.top + 20 })); told.diagram = clock();
  find('frame WORST').click(); told.worst = clock();
  const choice = document.getElementById('colour-choice'), ramps = [];
  for (const option of choice.options) {
    choice.value = option.value; choice.dispatchEvent(new Event('change'));
    const bar = document.getElementById('colour-bar');
    ramps.push(bar.hidden ? '' : bar.querySelector('input').value + ' ' + bar.querySelector('input:last-child').value);
  }
  told.ramps = ramps;
  for (const words of ['wireframe', 'shadows', 'grid', 'poncho', 'mannequin']) find(words).querySelector('input').click();
  for (const words of ['back', 'side', 'top']) find(words).click();
  for (const one of document.querySelectorAll('details')) one.open = true;
  const canvas = document.getElementById('canvas');
  canvas.focus();
  for (const key of ['ArrowLeft', 'ArrowUp', '+']) canvas.dispatchEvent(new KeyboardEvent('keydown', { key, shiftKey: true, bubbles: true, cancelable: true }));
  told.still = clock();
  document.body.dataset.use = JSON.stringify(told);
}, 500);
</script>'''


class Body(html.parser.HTMLParser):
    """The data attributes of <body> and the text of the page."""

    def __init__(self, text):
        super().__init__()
        self.facts, self.words, self.hidden = {}, [], 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag == 'body':
            self.facts = {name[5:]: value for name, value in attributes if name.startswith('data-')}
        self.hidden += tag in ('script', 'style')

    def handle_endtag(self, tag):
        self.hidden -= tag in ('script', 'style')

    def handle_data(self, data):
        if not self.hidden:
            self.words.append(data)

    def text(self):
        return ' '.join(' '.join(self.words).split())


class Browser:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def call(self, url, size, *options):
        """(standard output, lines of the console)"""
        with tempfile.TemporaryDirectory() as profile:
            command = [self.program, '--headless', '--no-sandbox', '--disable-dev-shm-usage', '--hide-scrollbars', '--enable-logging=stderr',
                       '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', f'--user-data-dir={profile}',
                       f'--window-size={size[0]},{size[1]}', f'--virtual-time-budget={VIRTUAL_MS}', *options, url]
            done = subprocess.run(command, capture_output=True, timeout=SECONDS, check=False, env={**os.environ, 'HOME': profile})
        console = [line for line in done.stderr.decode(errors='replace').splitlines() if re.search(r':CONSOLE[:(]', line)]
        return done.stdout.decode(errors='replace'), console

    def open(self, page, size, *options):
        """The page as it is at the end, and the lines of the console."""
        for tried in range(1, TRIES + 1):
            text, console = self.call(page.as_uri() + '#test', size, '--dump-dom', *options)
            body = Body(text)
            if 'done' in body.facts or console:
                break
        if tried > 1:
            print(f'{page.name}: drawn at try {tried}')
        return body, console

    def open_framed(self, page, size):
        """The same of a page in a frame, which tells its facts to the page around it."""
        around = page.with_name('framed.html')
        around.write_text(FRAME % (page.name, *size))
        body, console = self.open(around, WINDOW)
        around.unlink()
        return body, console

    def picture(self, url, size, name, *options):
        if self.folder:
            self.call(url, size, f'--screenshot={self.folder / name}', *options)


class Faults(list):
    def expect(self, true, what):
        if not true:
            self.append(what)
            print(f'NOT as it should be: {what}')


def write_page(percale, scene, folder, *options):
    command = [percale, 'run', scene, '-o', folder, '--report', '--quiet', *options]
    done = subprocess.run(command, capture_output=True, timeout=SECONDS, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f'{" ".join(map(str, command))}: exit code {done.returncode}: {done.stderr.decode(errors="replace")}')
    return folder / 'report.html'


def check_playback(faults, opened, size, *options):
    body, console = opened
    facts, what = body.facts, f'{size[0]} pixels {" ".join(options)}'
    number = lambda name: int(facts.get(name, -1))
    faults.expect(not console, f'{what}: the console says {console[:3]}')
    faults.expect(facts.get('done') == 'yes', f'{what}: the page did not get to its end: {facts}')
    faults.expect(facts.get('errors') == '0', f'{what}: errors: {facts.get("errors")}')
    faults.expect(facts.get('width') == str(size[0]), f'{what}: the window is {facts.get("width")} pixels wide')
    faults.expect(facts.get('overflow') == '0', f'{what}: wider than the window by {facts.get("overflow")} pixels')
    for frame in ('first', 'last'):
        faults.expect(number(f'{frame}-covered') > LEAST_COVERED * 300 * 300, f'{what}: the {frame} frame shows nothing')
    faults.expect(number('first-pixels') != number('last-pixels'), f'{what}: the first frame looks like the last')
    faults.expect(number('played-to') >= 1, f'{what}: playing moved nothing')
    faults.expect(number('frames') == 10, f'{what}: {facts.get("frames")} frames, not 10')
    print(f'{what}: {facts}')


def check_tables(faults, body, what):
    for words in ('Certificate', 'Expectations', 'The run', 'Newton iterations', 'CPU time by stage', 'Settings'):
        faults.expect(words in body.text(), f'{what}: "{words}" is not on the page')


def check_without_view(faults, browser, page, what, words, *options):
    body, console = browser.open(page, WIDE, *options)
    faults.expect(body.facts.get('done') == 'no view', f'{what}: {body.facts}')
    faults.expect('ran' not in body.facts, f'{what}: markup of a title ran')
    faults.expect(words in body.text(), f'{what}: "{words}" is not on the page')
    check_tables(faults, body, what)
    return console


def check_use(faults, browser, page):
    worst = json.loads((page.parent / 'report.json').read_text())['worst_frame']
    used = page.with_name('used.html')
    used.write_text(page.read_text().replace('</body>', USE.replace('WORST', str(worst)) + '</body>'))
    text, console = browser.call(used.as_uri(), WIDE, '--dump-dom')
    used.unlink()
    told = json.loads(Body(text).facts.get('use', '{}'))
    ramps = told.pop('ramps', [])
    wanted = {'start': 9, 'left': 8, 'home': 0, 'right': 1, 'slider': 6, 'diagram': 9, 'worst': worst, 'still': worst}
    faults.expect(not console, f'used: the console says {console[:3]}')
    faults.expect(told == wanted, f'used: {told}, not {wanted}')
    faults.expect(len(ramps) == 3 and ramps[0] == '' and all(float(ramp.split()[0]) < float(ramp.split()[1]) for ramp in ramps[1:]),
                  f'used: colours from {ramps}')
    print(f'used: {told}, colours {ramps}')


def check_broken(faults, browser, page):
    """What looks for faults must see one."""
    broken = page.with_name('broken.html')
    broken.write_text(page.read_text().replace('\nstart();', '\nstart(); nothing_of_this_name();'))
    _, console = browser.open(broken, WIDE)
    broken.unlink()
    faults.expect(any('nothing_of_this_name' in line for line in console), f'an error of a page was not seen: {console}')


def check(percale, scene, browser, folder):
    faults = Faults()
    page = write_page(percale, scene, folder / 'run', '--set', 'duration=0.3')
    wide = browser.open(page, WIDE)
    check_playback(faults, wide, WIDE)
    check_tables(faults, wide[0], 'wide')
    check_playback(faults, browser.open_framed(page, NARROW), NARROW)
    dark = '--blink-settings=preferredColorScheme=0'
    check_playback(faults, browser.open(page, WIDE, dark), WIDE, dark)
    for name, size, *options in (('wide.png', (1280, 2200)), ('narrow.png', (390, 3600)), ('dark.png', (1280, 2200), dark)):
        browser.picture(page.as_uri(), size, name, *options)
    titled = write_page(percale, scene, folder / 'titled', '--set', 'duration=0.05', '--set', f"title='''{MARKUP}'''", '--frames', 'none')
    console = check_without_view(faults, browser, titled, 'markup as title', MARKUP.replace('  ', ' '))
    faults.expect(not console, f'markup as title: the console says {console[:3]}')
    check_without_view(faults, browser, page, 'without WebGL', 'offers no WebGL', '--disable-3d-apis')
    check_use(faults, browser, page)
    check_broken(faults, browser, page)
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('percale')
    parser.add_argument('scene')
    parser.add_argument('-o', dest='folder', type=Path)
    parser.add_argument('--browser')
    arguments = parser.parse_args()
    program = arguments.browser or next(filter(None, map(shutil.which, BROWSERS)), None)
    if program is None:
        print(f'skipped: none of {", ".join(BROWSERS)} is installed')
        return SKIPPED
    help_text = subprocess.run([arguments.percale, 'report', 'x'], capture_output=True, timeout=SECONDS, check=False).stderr
    if b'this build writes no pages' in help_text:
        print('skipped: this build has no three.js (libjs-three)')
        return SKIPPED
    with tempfile.TemporaryDirectory() as scratch:
        folder = (arguments.folder or Path(scratch)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        faults = check(arguments.percale, arguments.scene, Browser(program, folder if arguments.folder else None), folder)
    print(f'{len(faults)} faults')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
