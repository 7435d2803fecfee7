/** Between lines of the text and nodes. Pure. */
import { allNodes, type EditNode } from './model'

/** The innermost node whose text covers a line. */
export function nodeAtLine(root: EditNode, line: number): EditNode | undefined {
  return allNodes(root)
    .filter((node) => node.line <= line && line <= node.end_line)
    .reduce<EditNode | undefined>((best, node) => (!best || node.path.length >= best.path.length ? node : best), undefined)
}

/** What is being written at a place of the text: the key before the cursor and the words above it. */
export interface Writing {
  /** The key that the value belongs to; empty while a key is written. */
  readonly key: string
  readonly word: string
  /** The keys of the mappings around, from the inside out, as far as they can be told from the indentation. */
  readonly around: readonly string[]
}

const KEY = /^(\s*(?:- )*)([A-Za-z_][\w-]*|"[^"]*"):(\s|$)/

/** Look at the lines above: YAML in blocks says by its indentation where one is; braces on one line are looked at too. */
export function writingAt(text: string, offset: number): Writing {
  const before = text.slice(0, offset)
  const lines = before.split('\n')
  const line = lines[lines.length - 1] ?? ''
  const inFlow = flowAt(line)
  const segment = inFlow ?? line.replace(/^\s*(- )*/, '')
  const pair = /^\s*("?[\w-]+"?):\s+(.*)$/.exec(segment)
  const word = /[\w./-]*$/.exec(line)?.[0] ?? ''
  const around: string[] = []
  if (inFlow !== undefined) around.push(...openKeys(line))
  let indent = /^\s*/.exec(line)?.[0].length ?? 0
  const own = KEY.exec(line)
  if (inFlow !== undefined && own?.[2]) around.push(own[2])
  for (let index = lines.length - 2; index >= 0 && indent > 0; index -= 1) {
    const found = KEY.exec(lines[index] ?? '')
    const at = found?.[1]?.length ?? Infinity
    if (found?.[2] && at < indent) {
      around.push(found[2])
      indent = at
    }
  }
  return { key: pair?.[1]?.replaceAll('"', '') ?? '', word, around: [...new Set(around)] }
}

/** The last part inside braces that are still open; undefined outside of braces. */
function flowAt(line: string): string | undefined {
  let depth = 0
  for (let index = line.length - 1; index >= 0; index -= 1) {
    const letter = line[index]
    if (letter === '}' && line[index - 1] !== '"') depth += 1
    if (letter === '{' && line[index - 1] !== '$') {
      if (depth === 0)
        return (
          line
            .slice(index + 1)
            .split(/,(?![^[]*\])/)
            .pop() ?? ''
        )
      depth -= 1
    }
  }
  return undefined
}

/** The keys before the braces that are open, from the inside out. */
function openKeys(line: string): readonly string[] {
  const keys: string[] = []
  const stack: string[] = []
  for (const found of line.matchAll(/([\w-]+):\s*\{|\{|\}/g)) {
    if (found[0] === '}') stack.pop()
    else stack.push(found[1] ?? '')
  }
  keys.push(...stack.toReversed().filter(Boolean))
  return keys
}

/** The state that the mapping around a line runs, from the lines near it. */
export function stateNear(text: string, offset: number): string | undefined {
  const lines = text.slice(0, offset).split('\n')
  const rest = text.slice(offset).split('\n')
  const here = (lines.at(-1) ?? '') + (rest[0] ?? '')
  const inLine = /state:\s*([\w.:]+)/.exec(here)
  if (inLine?.[1]) return inLine[1]
  for (let index = lines.length - 2; index >= Math.max(0, lines.length - 12); index -= 1) {
    const found = /state:\s*([\w.:]+)/.exec(lines[index] ?? '')
    if (found?.[1]) return found[1]
  }
  return undefined
}
