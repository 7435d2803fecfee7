/** Laying out a whole behavior that is drawn once: a version, or a file to be taken along. */
import type { LayoutCall } from '../../document/elkGraph'
import { arrange, type Arrangement } from '../../document/editing/arrange'
import { declaredOutcomes, expandedByDefault } from '../../document/editing/expansion'
import type { EditNode } from '../../document/editing/model'
import type { DrawnInput } from './elements'

export interface Drawing extends DrawnInput {
  readonly arrangement: Arrangement
}

export async function drawingOf(
  root: EditNode,
  outcomes: readonly string[],
  isOpen: (path: string) => boolean,
  rowLimit: number,
  call: LayoutCall,
): Promise<Drawing> {
  const declared = declaredOutcomes(root, outcomes)
  const arrangement = await arrange(root, { isOpen, declared, rowLimit, call })
  return { root, scope: root, arrangement, isOpen, declared }
}

/** Open what is open by itself on the canvas. */
export function openWith(root: EditNode): (path: string) => boolean {
  const byItself = expandedByDefault(root)
  return (path) => byItself.has(path)
}
