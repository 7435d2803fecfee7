/** The edits since the behavior was opened, the latest first; one click undoes or redoes all up to one of them. */
import { ActionIcon, Menu, ScrollArea, Tooltip } from '@mantine/core'
import { IconHistory } from '@tabler/icons-react'
import { jumpTo } from './apply'
import { useEditor } from './store'

const SHOWN = 200

export function EditHistory() {
  const { steps, at } = useEditor((s) => s.history)
  const first = Math.max(0, steps.length - SHOWN)
  const shown = steps.slice(first).map(({ label }, index) => ({ label, at: first + index }))
  return (
    <Menu position="bottom-end" shadow="md" returnFocus>
      <Menu.Target>
        <Tooltip label="History of edits">
          <ActionIcon variant="subtle" color="gray" aria-label="History of edits" disabled={steps.length < 2}>
            <IconHistory size={16} aria-hidden />
          </ActionIcon>
        </Tooltip>
      </Menu.Target>
      <Menu.Dropdown aria-label="History of edits">
        <ScrollArea.Autosize mah="60vh">
          {shown.toReversed().map((step) => (
            <Menu.Item
              key={step.at}
              aria-current={step.at === at ? 'step' : undefined}
              {...(step.at > at ? { c: 'dimmed' } : {})}
              {...(step.at === at ? { fw: 600 } : {})}
              onClick={() => jumpTo(step.at)}
            >
              {step.label}
            </Menu.Item>
          ))}
        </ScrollArea.Autosize>
      </Menu.Dropdown>
    </Menu>
  )
}
