#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What plugins_cache.py writes is what gst-inspect-1.0 says of the same plugins.

usage: test_plugins_cache.py SCRIPT PLUGIN...       GST_PLUGIN_PATH names the plugins' folders
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SCRIPT, *PLUGINS = sys.argv[1:]
GSTREAMERS = {'name', 'parent', 'qos', 'async-handling', 'message-forward'}
PROPERTY = re.compile(r'^  (\S+) *: (.*)\n((?: {24}.*\n)+)', re.M)
RANGE = re.compile(r'Range: +(\S+) - +(\S+) Default: +(\S+)')
MEMBER = re.compile(r'^ +\((\d+)\): (\S+) +- (.*)$', re.M)
MUTABLE = {'changeable in NULL, READY, PAUSED or PLAYING state': 'playing',
           'changeable only in NULL or READY state': 'ready'}


def inspect(what):
    return subprocess.run(['gst-inspect-1.0', '--no-colors', what], capture_output=True, text=True,
                          check=True, env={**os.environ, 'LC_ALL': 'C.UTF-8'}).stdout


def section(text, title):
    """The lines below a title up to the next one."""
    return ''.join(re.findall(rf'^{title}:\n((?:[ \n].*\n?)*)', text, re.M))


def written():
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / 'cache.json'
        subprocess.run([sys.executable, SCRIPT, str(file), *PLUGINS], check=True)
        return json.loads(file.read_text(encoding='utf-8'))


class PluginsCache(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cache = written()
        cls.elements = {name: (element, plugin['other-types'])
                        for plugin in cls.cache.values()
                        for name, element in plugin['elements'].items()}

    def test_has_every_element_of_every_plugin(self):
        told = {re.search(r'^  Name +(\w+)$', text, re.M)[1]: re.findall(r'^  (\w+): ', text, re.M)
                for text in map(inspect, PLUGINS)}
        self.assertTrue(all(told.values()))
        self.assertEqual({name: sorted(plugin['elements']) for name, plugin in self.cache.items()},
                         {name: sorted(names) for name, names in told.items()})

    def test_has_every_property_as_it_is(self):
        for name, (element, types) in self.elements.items():
            told = PROPERTY.findall(section(inspect(name), 'Element Properties'))
            names = {prop for prop, _, _ in told} - GSTREAMERS
            self.assertEqual(names, set(element['properties']), name)
            for prop, blurb, details in told:
                if prop not in GSTREAMERS:
                    with self.subTest(element=name, property=prop):
                        self.compare(element['properties'][prop], blurb, details, types)

    def compare(self, described, blurb, details, types):
        self.assertEqual(described['blurb'], blurb)
        flags = re.search('flags: (.*)', details)[1]
        for flag in ('readable', 'writable', 'controllable'):
            self.assertEqual(described[flag], flag in flags)
        changeable = [state for words, state in MUTABLE.items() if words in flags]
        self.assertEqual(described['mutable'], (changeable or ['null'])[0])
        numbers = RANGE.search(details)
        self.assertEqual(bool(numbers), 'min' in described)
        if numbers:
            self.assertEqual([float(described[key]) for key in ('min', 'max', 'default')],
                             [float(number) for number in numbers.groups()])
        members = MEMBER.findall(details)
        self.assertEqual(bool(members), described['type'] in types)
        if members:
            self.assertEqual([(one['value'], one['name'], one['desc'])
                              for one in types[described['type']]['values']], members)
            number, nick = re.search(r'Default: (\d+), "(.*)"', details).groups()
            self.assertEqual(described['default'], f'{nick} ({number})')
        text = re.search(r'(?:String|Boolean)\. Default: (.*)', details)
        if text:
            self.assertEqual(described['default'], text[1].strip('"'))

    def test_has_every_pad_with_its_caps(self):
        for name, (element, _) in self.elements.items():
            text = section(inspect(name), 'Pad Templates')
            told = re.findall(r"template: '(\w+)'\n.*\n    Capabilities:\n((?: {6}.*\n)+)", text)
            self.assertEqual([pad for pad, _ in sorted(told)], sorted(element['pad-templates']))
            for pad, caps in told:
                described = element['pad-templates'][pad]['caps']
                said = caps.replace('(string)', '').replace(':', '').split()
                self.assertEqual(described.replace(':', '').split(), said)

    def test_has_every_action(self):
        for name, (element, _) in self.elements.items():
            told = re.findall(r'^  "([\w-]+)" ', section(inspect(name), 'Element Actions'), re.M)
            described = [signal for signal, what in element.get('signals', {}).items()
                         if what.get('action')]
            self.assertEqual(described, told, name)
        self.assertIn('reopen', self.elements['regionwrite'][0]['signals'])


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1])
