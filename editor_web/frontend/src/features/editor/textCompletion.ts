/** What can be written at a place of the text: states, entries, parameters, targets, names in `${…}`. */
import type { Completion, CompletionContext, CompletionResult } from '@codemirror/autocomplete'
import { openingAt } from '../../document/editing/completion'
import { allNodes, nodeOf } from '../../document/editing/model'
import { nodeAtLine, stateNear, writingAt } from '../../document/editing/textPositions'
import { plainText } from '../../document/values'
import { parentPath } from '../../document/path'
import { draftOf, editor, rootOf } from './store'

const NODE_KEYS = [
  'state',
  'with',
  'in',
  'out',
  'transitions',
  'timeout',
  'retry',
  'guard',
  'on_error',
  'autonomy',
  'resume',
  'description',
]

export function completeText(context: CompletionContext): CompletionResult | null {
  const text = context.state.doc.toString()
  const names = namesHere()
  const opening = openingAt(
    text.slice(context.state.doc.lineAt(context.pos).from),
    context.pos - context.state.doc.lineAt(context.pos).from,
    names.map((name) => ({ name, origin: '', detail: '' })),
  )
  if (opening) return { from: context.pos - opening.word.length, options: names.map((label) => ({ label, type: 'variable' })) }
  const writing = writingAt(text, context.pos)
  const options = optionsFor(text, context.pos, writing.key, writing.around)
  if (options.length === 0 || (writing.word === '' && !context.explicit && writing.key === '')) return null
  return { from: context.pos - writing.word.length, options: [...options], validFor: /^[\w./-]*$/ }
}

function namesHere(): readonly string[] {
  const { document } = draftOf(editor())
  const root = rootOf(editor())
  const written = root ? allNodes(root).flatMap((node) => [...Object.values(node.outputs), ...Object.keys(node.userdata)]) : []
  return [...new Set([...Object.keys(document?.parameters ?? {}), ...Object.keys(document?.userdata ?? {}), ...written])]
}

function optionsFor(text: string, at: number, key: string, around: readonly string[]): readonly Completion[] {
  const { catalogue } = editor()
  if (!catalogue) return []
  if (key === 'state')
    return catalogue.states.map((state) => ({
      label: state.name,
      type: 'class',
      detail: state.doc.split('\n')[0] ?? '',
    }))
  if (key === 'entry') return catalogue.entries.map((entry) => ({ label: entry.name, type: 'constant', detail: entry.kind }))
  if (key === 'behavior') return catalogue.behaviors.map((behavior) => ({ label: behavior.id, type: 'text', detail: behavior.description }))
  if (key === '' && around[0] === 'with') {
    const state = catalogue.states.find((each) => each.name === stateNear(text, at))
    return (state?.parameters ?? []).map((parameter) => ({
      label: parameter.name,
      type: 'property',
      apply: `${parameter.name}: `,
      detail: plainText(parameter.schema['description']),
    }))
  }
  if (around[0] === 'transitions' || key === 'initial' || key === 'to' || key === 'on_error') {
    const root = rootOf(editor())
    const node = root && nodeAtLine(root, text.slice(0, at).split('\n').length)
    if (key === '') return (node?.outcomes ?? []).map((label) => ({ label, type: 'enum', apply: `${label}: ` }))
    const parent = node && (key === 'initial' ? node : nodeOf(root, parentPath(node.path)))
    const names = [...(parent?.children.map((child) => child.name) ?? []), ...(parent?.outcomes ?? [])]
    return [...new Set(names)].map((label) => ({ label, type: 'enum' }))
  }
  if (key === 'resume') return ['rerun', 'ask'].map((label) => ({ label, type: 'keyword' }))
  if (around[0] === 'autonomy' && key !== '') return ['off', 'low', 'high', 'full'].map((label) => ({ label, type: 'keyword' }))
  if (key === '' && (around[1] === 'states' || around[0] === 'root')) {
    return [...NODE_KEYS, ...catalogue.containers.filter((each) => !each.only_in_tree).map((each) => each.kind)].map((label) => ({
      label,
      type: 'keyword',
      apply: `${label}: `,
    }))
  }
  return []
}
