/** Who has the page open, who operates since when, and how one is called. */
import { Avatar, Group, Popover, Stack, Text, TextInput, UnstyledButton, VisuallyHidden } from '@mantine/core'
import { IconHandStop } from '@tabler/icons-react'
import { useLive } from '../../api/live'
import { rename, useOwnPresence } from '../../api/presence'
import type { Presence, RunView } from '../../api/types'
import { initialsOf, placeWords } from '../../document/presence'
import { nameOfPath } from '../../document/path'
import { wallTime } from '../../document/time'

const SHOWN = 3

export function People() {
  const present = useLive((s) => s.present)
  const page = useLive((s) => s.page)
  const runs = useLive((s) => s.runs)
  const name = useOwnPresence((s) => s.name)
  const operating = present.filter((each) => each.operates !== '')
  if (present.length === 0) return null
  return (
    <Popover position="bottom-end" shadow="md" width={300} withinPortal>
      <Popover.Target>
        <UnstyledButton data-present={present.length}>
          {/* Said before the initials, which are part of the name because they are seen. */}
          <VisuallyHidden>
            {present.length} {present.length === 1 ? 'page' : 'pages'} open{operating.map((each) => `, ${each.name} operates`).join('')}
          </VisuallyHidden>
          <Group gap="2xs" wrap="nowrap">
            {operating[0] && (
              <Text span size="xs" fw={600} visibleFrom="md" data-operates={operating[0].operates}>
                {operating[0].page === page ? 'You operate' : `${operating[0].name} operates`}
              </Text>
            )}
            <Avatar.Group spacing="xs">
              {present.slice(0, SHOWN).map((each) => (
                <Avatar key={each.page} size={26} color={each.page === page ? 'gray' : 'initials'} name={each.name} title={each.name}>
                  {initialsOf(each.name)}
                </Avatar>
              ))}
              {present.length > SHOWN && <Avatar size={26}>+{present.length - SHOWN}</Avatar>}
            </Avatar.Group>
          </Group>
        </UnstyledButton>
      </Popover.Target>
      <Popover.Dropdown>
        <Stack gap="xs">
          <ul className="plain-list" aria-label="Open pages">
            {present.map((each) => (
              <Person key={each.page} person={each} isOwn={each.page === page} run={runs.find((run) => run.id === each.operates)} />
            ))}
          </ul>
          <TextInput
            size="xs"
            label="Your name"
            description="Others see it while this page is open"
            placeholder={present.find((each) => each.page === page)?.name}
            maxLength={40}
            defaultValue={name}
            onBlur={(event) => rename(event.currentTarget.value)}
            onKeyDown={(event) => event.key === 'Enter' && rename(event.currentTarget.value)}
          />
        </Stack>
      </Popover.Dropdown>
    </Popover>
  )
}

function Person({ person, isOwn, run }: { readonly person: Presence; readonly isOwn: boolean; readonly run: RunView | undefined }) {
  return (
    <Group component="li" gap="xs" wrap="nowrap" py="4xs" data-person={person.name}>
      <Avatar size={26} color={isOwn ? 'gray' : 'initials'} name={person.name}>
        {initialsOf(person.name)}
      </Avatar>
      <div>
        <Text size="sm" fw={600}>
          {person.name}
          {isOwn && ' (this page)'}
        </Text>
        <Text size="xs" c="var(--quiet)">
          {placeWords(person)}
        </Text>
        {person.operates && (
          <Group gap="4xs" fz="xs">
            <IconHandStop size={13} aria-hidden /> Operates {run ? nameOfPath(run.behavior) : person.operates}
            {person.since_s !== null && ` since ${wallTime(person.since_s)}`}
          </Group>
        )}
      </div>
    </Group>
  )
}
