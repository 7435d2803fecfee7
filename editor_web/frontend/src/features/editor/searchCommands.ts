/** What the editor offers to the search of the page: its commands, and the nodes of the document as it is now. */
import { keyOf } from '../../api/keyMap'
import type { PageCommand } from '../../api/search'
import { allNodes } from '../../document/editing/model'
import { parentPath } from '../../document/path'
import { COMMANDS, disabledReason } from './commands'
import { reveal } from './session'
import { editor, rootOf } from './store'

export function searchCommands(): readonly PageCommand[] {
  const root = rootOf(editor())
  const commands = COMMANDS.map((command): PageCommand => ({
    id: `command:${command.id}`,
    title: command.words,
    group: 'Commands',
    hint: keyOf(command.id),
    obstacle: disabledReason(command),
    // The search closes first: what is opened keeps the keyboard.
    run: () => setTimeout(() => command.run()),
  }))
  const nodes = root ? allNodes(root).slice(1) : []
  return [
    ...commands,
    ...nodes.map((node): PageCommand => ({
      id: `node:${node.path}`,
      title: node.name,
      group: 'In this behavior',
      icon: node.icon,
      detail: [node.title, parentPath(node.path)].filter(Boolean).join(' · '),
      run: () => reveal(node.path),
    })),
  ]
}
