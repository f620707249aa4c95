"""Prints three folders, each below its prefix, where this Python looks for packages: under /usr, under /usr/local, under any other;
and the middle number of its version.

Debian's Python looks in folders of its own under the first two; elsewhere, as in virtual environments, all are alike.
"""
import sys
import sysconfig


def folder(scheme, base, prefix):
    if scheme not in sysconfig.get_scheme_names():
        scheme, base = 'posix_prefix', prefix
    path = sysconfig.get_path('platlib', scheme, vars={'base': base, 'platbase': base})
    return path.removeprefix(prefix + '/')


print(folder('deb_system', '/usr', '/usr'), folder('posix_local', '/usr', '/usr/local'), folder('posix_prefix', '/any', '/any'),
      sys.version_info.minor, sep=';')
