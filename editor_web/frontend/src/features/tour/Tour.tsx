/** The tour: a card beside the real thing to press, and a ring around it; who does the step is who takes the tour. */
import { CloseButton, Flex, Group, Paper, Text, Title } from '@mantine/core'
import { useEffect, useLayoutEffect, useRef, useState } from 'react'
import { createPortal } from 'react-dom'
import { endTour, leaveTour, openTour, setTour, useTour } from '../../api/tour'
import { CommandButton } from '../../components/CommandButton'
import { placeBeside } from './place'
import { END, STEPS } from './steps'
import classes from './Tour.module.css'
import { useTourStep, type Seen } from './useTourStep'

export interface TourProps {
  /** Which page is shown, and of which behavior. */
  readonly page: string
  readonly id: string
  readonly onEdit: (id: string) => void
  readonly onBehavior: (id: string) => void
}

export function Tour(props: TourProps) {
  const seen = useTourStep(props.page, props.id)
  const at = useTour((s) => s.step)
  return createPortal(
    <>
      {seen.box && at < STEPS.length && <div className={classes.ring} data-tour="ring" style={ringAround(seen.box)} aria-hidden />}
      <Card {...props} seen={seen} at={at} />
    </>,
    seen.dialog ?? document.body,
  )
}

function Card({ page, id, onEdit, onBehavior, seen, at }: TourProps & { readonly seen: Seen; readonly at: number }) {
  const made = useTour((s) => s.document)
  const isFresh = useTour((s) => s.isFresh)
  const card = useRef<HTMLElement>(null)
  const [place, setPlace] = useState({ left: 0, top: 0 })
  const step = STEPS[at]
  const isElsewhere = step !== undefined && step.page !== 'any' && (id !== made || (step.page === 'edit') !== (page === 'edit'))
  const { title, words } = step ?? END

  useLayoutEffect(() => {
    const size = card.current?.getBoundingClientRect()
    if (size) setPlace(placeBeside(isElsewhere ? undefined : seen.box, size, { width: innerWidth, height: innerHeight }, seen.clear))
  }, [seen, at, isElsewhere])
  // Whoever opens the tour by keyboard is in it.
  useEffect(() => {
    if (!isFresh) return
    card.current?.focus()
    setTour({ isFresh: false })
  }, [isFresh])

  return (
    <Paper
      ref={card}
      component="section"
      className={classes.card}
      pos="fixed"
      w="min(21rem, 100vw - 1.25rem)"
      bg="var(--raised)"
      ta="start"
      withBorder
      shadow="xl"
      radius="md"
      px="sm"
      pt="xs"
      pb="sm"
      data-tour="card"
      style={place}
      aria-label="Tour"
      tabIndex={-1}
    >
      <Flex component="header" align="center" justify="space-between">
        <Text span size="xs" fw={620} c="var(--accent)">
          {step ? `Step ${at + 1} of ${STEPS.length}` : 'Done'}
        </Text>
        <CloseButton
          size="sm"
          aria-label="Leave the tour"
          title="Leave the tour; it can be gone on with from the first page"
          onClick={leaveTour}
        />
      </Flex>
      <div aria-live="polite" aria-atomic>
        <Title order={2} size="md" mb={6}>
          {title}
        </Title>
        <Text size="sm" mb="xs">
          {isElsewhere ? `This is done with ${made.replace(/^behaviors\//, '')}, which is not on the page now.` : words}
        </Text>
        {step && !isElsewhere && (
          <Text size="sm" mb="xs" c="dimmed">
            {step.keys}
          </Text>
        )}
      </div>
      <Group gap={6}>
        {isElsewhere && (
          <CommandButton label="Go there" tone="strong" onPress={() => (step.page === 'edit' ? onEdit(made) : onBehavior(made))} />
        )}
        {step && !isElsewhere && (
          <CommandButton
            label="Show me"
            hint="Puts the keyboard there"
            obstacle={seen.target ? undefined : 'what it is about is not in sight'}
            onPress={() => focusIn(seen.target)}
          />
        )}
        {at > 0 && step && <CommandButton label="Restart" tone="quiet" onPress={beginAnew} />}
        {!step && <CommandButton label="Finish" tone="strong" onPress={endTour} />}
      </Group>
    </Paper>
  )
}

function beginAnew(): void {
  endTour()
  openTour()
}

/** Put the keyboard on an element, or on the first in it that takes it. */
function focusIn(target: HTMLElement | undefined): void {
  const inside = 'button, input, select, textarea, [tabindex="0"]'
  const takes = target?.matches(inside) ? target : target?.querySelector<HTMLElement>(inside)
  takes?.scrollIntoView({ block: 'nearest' })
  takes?.focus()
}

function ringAround({ left, top, width, height }: NonNullable<Seen['box']>) {
  const room = 4
  return { left: left - room, top: top - room, width: width + 2 * room, height: height + 2 * room }
}
