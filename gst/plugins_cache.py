#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Describes plugins as GStreamer's docs do in gst_plugins_cache.json, of which hotdoc makes pages.

usage: plugins_cache.py FILE PLUGIN...        PLUGIN: a .so; needs python3-gi, gir1.2-gstreamer-1.0

Elements with their pads, properties and signals, and the enumerations that these need. Values are
those of an element that was just made.
"""
import json
import pathlib
import re
import sys

import gi

gi.require_version('Gst', '1.0')
from gi.repository import GObject, Gst  # noqa: E402  pylint: disable=wrong-import-position

RANKS = ((Gst.Rank.NONE, 'none'), (Gst.Rank.MARGINAL, 'marginal'),
         (Gst.Rank.SECONDARY, 'secondary'), (Gst.Rank.PRIMARY, 'primary'))
MUTABLE = ((Gst.PARAM_MUTABLE_PLAYING, 'playing'), (Gst.PARAM_MUTABLE_PAUSED, 'paused'),
           (Gst.PARAM_MUTABLE_READY, 'ready'))
WHEN = ((GObject.SignalFlags.RUN_FIRST, 'first'), (GObject.SignalFlags.RUN_LAST, 'last'),
        (GObject.SignalFlags.RUN_CLEANUP, 'cleanup'))
SIGNAL_FLAGS = ((GObject.SignalFlags.NO_RECURSE, 'no-recurse'),
                (GObject.SignalFlags.DETAILED, 'detailed'), (GObject.SignalFlags.ACTION, 'action'),
                (GObject.SignalFlags.NO_HOOKS, 'no-hooks'))
FIELD = re.compile(r', ([\w-]+)=\([^)]+\)')
NUMBERS = ('gint', 'guint', 'gint64', 'guint64', 'gfloat', 'gdouble')


def rank_name(rank):
    nearest, name = min(RANKS, key=lambda known: abs(rank - int(known[0])))
    apart = rank - int(nearest)
    return f'{name} {"+" if apart > 0 else "-"} {abs(apart)}' if apart else name


def caps_text(caps):
    """A heading for each structure, and a line for each of its fields."""
    if caps.is_any() or caps.is_empty():
        return caps.to_string()
    parts = []
    for i in range(caps.get_size()):
        name, *fields = FIELD.split(caps.get_structure(i).to_string().rstrip(';'))
        features = caps.get_features(i)
        if features and (features.is_any() or features.to_string() != 'memory:SystemMemory'):
            name += f'({features.to_string()})'
        lines = [f'{field:>15}: {value}\n' for field, value in zip(fields[::2], fields[1::2])]
        parts.append(f'{name}:\n' + ''.join(lines))
    return '\n'.join(parts)


def pads_of(factory):
    return {template.name_template: {
        'caps': caps_text(template.get_caps()),
        'direction': template.direction.value_nick,
        'presence': template.presence.value_nick,
    } for template in factory.get_static_pad_templates()}


def number_text(value):
    return f'{value:g}' if isinstance(value, float) else str(value)


def default_text(spec, value):
    """None for what has no text."""
    if spec.value_type.is_a(GObject.TYPE_ENUM):
        return f'{value.value_nick} ({int(value)})'
    if spec.value_type == GObject.TYPE_BOOLEAN:
        return 'true' if value else 'false'
    if spec.value_type == GObject.TYPE_STRING:
        return 'NULL' if value is None else value
    if spec.value_type.name in NUMBERS:
        return number_text(value)
    return value.to_string() if isinstance(value, (Gst.Structure, Gst.Caps)) else None


def property_of(element, spec):
    flags = int(spec.flags)
    is_readable = bool(flags & GObject.ParamFlags.READABLE)
    described = {
        'blurb': spec.blurb,
        'conditionally-available': bool(flags & Gst.PARAM_CONDITIONALLY_AVAILABLE),
        'construct': bool(flags & GObject.ParamFlags.CONSTRUCT),
        'construct-only': bool(flags & GObject.ParamFlags.CONSTRUCT_ONLY),
        'controllable': bool(flags & Gst.PARAM_CONTROLLABLE),
        'mutable': next((state for flag, state in MUTABLE if flags & flag), 'null'),
        'readable': is_readable,
        'type': spec.value_type.name,
        'writable': bool(flags & GObject.ParamFlags.WRITABLE),
    }
    value = element.get_property(spec.name) if is_readable else spec.default_value
    default = default_text(spec, value)
    if default is not None:
        described['default'] = default
    if spec.value_type.name in NUMBERS:
        described.update(min=number_text(spec.minimum), max=number_text(spec.maximum))
    return described


def enum_of(member):
    members = type(member).__enum_values__
    return {'kind': 'enum', 'values': [
        {'desc': members[value].value_name, 'name': members[value].value_nick, 'value': str(value)}
        for value in sorted(members)]}


def signal_of(number):
    query = GObject.signal_query(number)
    described = {
        'args': [{'name': f'arg{i}', 'type': kind.name}
                 for i, kind in enumerate(query.param_types)],
        'return-type': query.return_type.name,
    }
    for flag, name in WHEN:
        if query.signal_flags & flag:
            described['when'] = name
            break
    described.update({name: True for flag, name in SIGNAL_FLAGS if query.signal_flags & flag})
    return query.signal_name, described


def hierarchy_of(kind):
    while kind != GObject.TYPE_INVALID:
        yield kind.name
        kind = kind.parent


def element_of(factory, other_types):
    element = factory.create(None)
    kind = element.__gtype__
    described = {key: factory.get_metadata(key) for key in factory.get_metadata_keys()
                 if key != 'long-name'}
    own = [spec for spec in element.list_properties() if spec.owner_type == kind]
    other_types.update({spec.value_type.name: enum_of(element.get_property(spec.name))
                        for spec in own
                        if spec.value_type.is_a(GObject.TYPE_ENUM)})
    described.update({
        'hierarchy': list(hierarchy_of(kind)),
        'pad-templates': pads_of(factory),
        'properties': {spec.name: property_of(element, spec) for spec in own},
        'rank': rank_name(factory.get_rank()),
    })
    interfaces = [one.name for one in kind.interfaces]
    signals = dict(signal_of(number) for number in GObject.signal_list_ids(kind))
    described.update({'interfaces': interfaces} if interfaces else {})
    described.update({'signals': signals} if signals else {})
    return described


def plugin_of(file):
    plugin = Gst.Plugin.load_file(file)
    other_types = {}
    features = Gst.Registry.get().get_feature_list_by_plugin(plugin.get_name())
    return plugin.get_name(), {
        'description': plugin.get_description(),
        'elements': {feature.get_name(): element_of(feature, other_types) for feature in features
                     if isinstance(feature, Gst.ElementFactory)},
        'filename': pathlib.Path(file).name.removeprefix('lib').split('.')[0],
        'license': plugin.get_license(),
        'other-types': other_types,
        'package': plugin.get_package(),
        'source': plugin.get_source(),
        'tracers': {},
        'url': plugin.get_origin(),
    }


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    Gst.init(None)
    text = json.dumps(dict(map(plugin_of, sys.argv[2:])), indent=4, sort_keys=True,
                      ensure_ascii=False)
    pathlib.Path(sys.argv[1]).write_text(text + '\n', encoding='utf-8')


if __name__ == '__main__':
    main()
