/** The menu of the selected nodes, where the pointer asked for it. */
import { Box, Kbd, Menu } from '@mantine/core'
import { Fragment } from 'react'
import { useKeyOf } from '../../api/keyMap'
import { isFrame, nodeOf, ROOT } from '../../document/editing/model'
import { usedBy } from '../../document/editing/usedBy'
import type { Command } from './command'
import { COMMANDS, disabledReason } from './commands'
import { chosenOf, editor, rootOf, setEditor, useEditor } from './store'

const ONE = [
  ['enter', 'open', 'connect', 'initial'],
  ['run-from', 'run-to'],
  ['disable', 'rename', 'replace', 'note'],
  ['duplicate', 'copy', 'cut', 'remove'],
  ['alike', 'usages', 'source'],
] as const
const SEVERAL = [
  ['disable', 'replace'],
  [
    'layout-selected',
    'align-left',
    'align-right',
    'align-top',
    'align-bottom',
    'align-row',
    'align-column',
    'distribute-across',
    'distribute-down',
  ],
  ['group', 'group-concurrency'],
  ['duplicate', 'copy', 'cut', 'remove'],
] as const

/** Where there is room neither below nor above the pointer, the menu lies on it. */
const IN_WINDOW = { flip: false, shift: { crossAxis: true, padding: 8 } } as const

export function NodeMenu() {
  const at = useEditor((s) => s.menu)
  const several = useEditor((s) => s.selection.length > 1)
  if (!at) return null
  const close = () => setEditor({ menu: undefined })
  const parts = (several ? SEVERAL : ONE).map((part) => part.flatMap((id) => shownCommand(id) ?? [])).filter((part) => part.length > 0)
  return (
    <Menu opened onClose={close} position="bottom-start" offset={2} middlewares={IN_WINDOW} withinPortal shadow="md" returnFocus>
      <Menu.Target>
        <Box component="span" pos="fixed" w={0} h={0} left={at.x} top={at.y} />
      </Menu.Target>
      <Menu.Dropdown aria-label="Selected nodes" mah="calc(100dvh - 16px)" style={{ overflowY: 'auto' }}>
        {parts.map((part, index) => (
          <Fragment key={part[0]?.id}>
            {index > 0 && <Menu.Divider />}
            {part.map((command) => (
              <Item key={command.id} command={command} />
            ))}
          </Fragment>
        ))}
      </Menu.Dropdown>
    </Menu>
  )
}

function Item({ command }: { command: Command }) {
  const key = useKeyOf(command.id).text
  const obstacle = disabledReason(command)
  return (
    <Menu.Item
      disabled={obstacle !== undefined}
      title={obstacle}
      rightSection={key && <Kbd size="xs">{key}</Kbd>}
      onClick={() => {
        setEditor({ menu: undefined })
        command.run()
      }}
    >
      {wordsNow(command)}
    </Menu.Item>
  )
}

/** The command, unless it means nothing for what is selected. */
function shownCommand(id: string): Command | undefined {
  const node = chosenOf(editor())
  if (!node || (node.path === ROOT && ['disable', 'rename', 'remove', 'run-from', 'run-to'].includes(id))) return undefined
  if ((id === 'enter' || id === 'open') && !isFrame(node) && node.document === null) return undefined
  if (id === 'source' && node.state === null) return undefined
  if ((id === 'alike' && !node.title) || (id === 'usages' && !usedBy(node))) return undefined
  return COMMANDS.find((command) => command.id === id)
}

/** Shorter than in the palette: here it is plain what is meant. */
const WORDS: Readonly<Record<string, string>> = {
  enter: 'Go in',
  open: 'Open or close in place',
  connect: 'Connect an outcome…',
  initial: 'Start with it',
  'layout-selected': 'Auto-layout',
  replace: 'Replace by…',
  note: 'Note',
  alike: 'Select all that run the same',
  usages: 'Find usages of what it runs',
  source: 'Show its Python source',
}

/** What it does to what is selected. */
function wordsNow(command: Command): string {
  const { selection } = editor()
  const nodes = selection.flatMap((path) => nodeOf(rootOf(editor()), path) ?? [])
  if (command.id === 'disable') {
    const verb = nodes.every((node) => node.disabled !== false) ? 'Enable' : 'Disable'
    return nodes.length > 1 ? `${verb} ${nodes.length} nodes` : verb
  }
  return WORDS[command.id] ?? command.words
}
