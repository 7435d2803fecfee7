/** Nodes for tests. */
import { nameOfPath } from '../path'
import type { EditNode } from './model'

export function node(path: string, outcomes: readonly string[], more: Partial<EditNode> = {}): EditNode {
  return {
    path,
    name: nameOfPath(path),
    kind: 'state',
    icon: 'state',
    title: 'test.State',
    outcomes,
    children: [],
    transitions: [],
    initial: null,
    conditions: [],
    disabled: false,
    description: '',
    parameters: {},
    inputs: {},
    outputs: {},
    rules: [],
    otherwise: null,
    timeout: null,
    retry: null,
    guard: null,
    on_error: null,
    autonomy: {},
    resume: null,
    position: null,
    label: '',
    end_line: 1,
    state: null,
    reference: null,
    document: null,
    targets: {},
    exits: [],
    success: [],
    every: null,
    role: '',
    post: null,
    notes: '',
    canvas_notes: {},
    userdata: {},
    settings: {},
    line: 1,
    column: 1,
    ...more,
  }
}

export function machineNode(
  path: string,
  initial: string,
  children: readonly EditNode[],
  arrows: readonly (readonly [string, string, string])[],
): EditNode {
  const inside = new Set(children.map((child) => child.name))
  return node(path, [...new Set(arrows.map(([, , target]) => target).filter((target) => !inside.has(target)))], {
    kind: 'machine',
    title: '',
    children,
    initial,
    transitions: arrows.map(([source, outcome, target]) => ({ source, outcome, target })),
  })
}
