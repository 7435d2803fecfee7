/** The marks of the timeline as a list: read and chosen by keys, told to those who do not see the lanes. */
import { ActionIcon, NavLink, Popover, ScrollArea, Stack, Text, Tooltip } from '@mantine/core'
import { IconList } from '@tabler/icons-react'
import { useState } from 'react'
import type { MeasuredMarkers } from '../../api/types'
import type { Mark } from '../../document/measured'
import { kindWord } from './words'

export interface MarkListProps {
  readonly marks: readonly Mark[]
  readonly measured: MeasuredMarkers | undefined
  readonly cursorS: number
  readonly onGo: (mark: Mark) => void
}

/** So many around the cursor are in the page; a long run has thousands of goals. */
const MOST = 200

export function MarkList({ marks, measured, cursorS, onGo }: MarkListProps) {
  const [isOpen, setOpen] = useState(false)
  return (
    <Popover opened={isOpen} onChange={setOpen} position="bottom-end" width={380} shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <Tooltip label="List of marks" openDelay={300}>
          <ActionIcon
            variant="subtle"
            color="gray"
            size="md"
            aria-label="List of marks"
            aria-expanded={isOpen}
            onClick={() => setOpen(!isOpen)}
          >
            <IconList size={16} />
          </ActionIcon>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown p={4}>{isOpen && <Marks {...{ marks, measured, cursorS, onGo }} />}</Popover.Dropdown>
    </Popover>
  )
}

function Marks({ marks, measured, cursorS, onGo }: MarkListProps) {
  const here = marks.findLastIndex((mark) => mark.time_s <= cursorS)
  const first = Math.max(0, Math.min(here - MOST / 2, marks.length - MOST))
  const notes = notesOf(measured, marks.length > MOST)
  return (
    <Stack gap={0}>
      <ScrollArea.Autosize mah={300} type="auto" scrollbars="y">
        <Stack component="ul" aria-label="Marks" gap={0} m={0} p={0} style={{ listStyle: 'none' }}>
          {marks.slice(first, first + MOST).map((mark, index) => (
            <li key={`${mark.seq} ${mark.kind} ${mark.text}`}>
              <NavLink
                component="button"
                py={3}
                active={first + index === here}
                aria-current={first + index === here ? 'step' : undefined}
                label={`${mark.time_s.toFixed(2)} s · ${kindWord(mark.kind)} · ${mark.text}`}
                description={mark.path}
                styles={{
                  label: { fontSize: '0.8rem' },
                  description: { '--description-opacity': 1, '--description-color': 'var(--quiet)' },
                }}
                onClick={() => onGo(mark)}
              />
            </li>
          ))}
        </Stack>
      </ScrollArea.Autosize>
      {marks.length === 0 && (
        <Text size="sm" c="dimmed" p="2xs">
          There are none of the kinds that are shown.
        </Text>
      )}
      {notes.map((note) => (
        <Text key={note} size="xs" c="dimmed" px="2xs" py={3}>
          {note}
        </Text>
      ))}
    </Stack>
  )
}

/** What is not in the list, and why. */
function notesOf(measured: MeasuredMarkers | undefined, isPart: boolean): readonly string[] {
  return [
    isPart ? `The ${MOST} marks around the cursor are listed.` : '',
    measured?.unread ? `Forces and limits of telemetry are missing: ${measured.unread}.` : '',
    measured && measured.every > 1 ? `One message in ${measured.every} was read: peaks between them are missing.` : '',
    measured && measured.left_out > 0 ? `${measured.left_out} more limits were left out.` : '',
  ].filter(Boolean)
}
